// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/identity.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "store/files.hpp"
#include "store/rows.hpp"
#include "store/schema.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

std::string identity_path(const std::string& folder) { return folder + "/identity"; }

/// The identity in a folder; empty if it has none.
std::string identity_in(const std::string& folder) {
  const auto bytes = read_file(identity_path(folder));
  return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

std::string identity_in(Connection& connection) {
  Statement select = connection.prepare("SELECT identity FROM store");
  return select.step() ? select.text(0) : std::string();
}

/// What a store has left in a folder: files, and an identity.
struct Left {
  explicit Left(const std::string& in) : folder(in), identity(identity_in(in)) {
    for (const FileKind kind : file_kinds)
      for (std::string& name : file_names(folder_of(in, kind)))
        files.emplace_back(kind, std::move(name));
  }

  bool anything() const { return !identity.empty() || !files.empty(); }

  std::string count(FileKind kind) const {
    return std::to_string(std::ranges::count(files, kind, &File::first));
  }

  /// The error of a database that does not go with the folder; `is` says why.
  Error refused(const std::string& is) const {
    return {Reason::storage,
            "the data folder " + folder +
                " has the files of a store (meshes: " + count(FileKind::mesh) +
                ", results: " + count(FileKind::result) + ", uploads: " + count(FileKind::upload) +
                "), but " + database_path(folder) + " " + is +
                ": restore the database of that store from a backup, move the folder away to start "
                "anew, or let anticrackd --check-store --repair move aside what does not belong "
                "together"};
  }

  using File = std::pair<FileKind, std::string>;  ///< kind and name
  std::string folder;
  std::string identity;  ///< empty if there is none
  std::vector<File> files;
};

}  // namespace

void require_database(const std::string& folder) {
  const std::optional<std::uint64_t> bytes = file_size(database_path(folder));
  if (const Left left(folder); bytes.value_or(0) == 0 && left.anything())
    throw left.refused(bytes ? "is empty" : "is missing");
}

void require_own(Connection& connection, const std::string& folder) {
  const Left left(folder);
  if (connection.integer("PRAGMA user_version") == 0) {
    if (left.anything()) throw left.refused("is empty");
    return;
  }
  require_version(connection);
  const std::string identity = identity_in(connection);
  if (!left.identity.empty()) {
    if (identity != left.identity)
      throw left.refused("is another store's (" + identity + ", not " + left.identity + ")");
  } else if (!left.files.empty() && std::ranges::none_of(left.files, [&](const auto& file) {
               return is_referenced(connection, file.first, file.second);
             })) {
    throw left.refused("refers to none of them");
  }
}

void keep_identity(Connection& connection, const std::string& folder) {
  const std::string identity = identity_in(connection);
  if (identity != identity_in(folder))
    replace_file(identity_path(folder), std::as_bytes(std::span(identity)));
}

}  // namespace anticrack::store
