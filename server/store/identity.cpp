// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/identity.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "store/files.hpp"
#include "store/references.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

std::string identity_path(const std::string& folder) {
  return folder + "/identity";
}

/// Empty: the folder has none.
std::string identity_in(const std::string& folder) {
  const auto bytes = read_file(identity_path(folder));
  return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "";
}

/// Empty: the database was made before there were any.
std::string identity_in(Connection& connection) {
  if (connection.integer("SELECT count(*) FROM sqlite_schema WHERE name = 'store'") == 0) {
    return {};
  }
  Statement select = connection.prepare("SELECT identity FROM store");
  return select.step() ? select.text(0) : std::string();
}

std::string count(std::size_t number, const std::string& one, const std::string& many) {
  return std::to_string(number) + " " + (number == 1 ? one : many);
}

/// What a store has left in a folder.
struct Left {
  explicit Left(const std::string& in) : folder(in), identity(identity_in(in)) {
    for (const FileKind kind : file_kinds) {
      files[static_cast<std::size_t>(kind)] = file_names(folder_of(in, kind));
    }
  }

  const std::vector<std::string>& of(FileKind kind) const {
    return files[static_cast<std::size_t>(kind)];
  }
  bool any_file() const {
    return std::ranges::any_of(files, [](const auto& names) { return !names.empty(); });
  }
  bool anything() const { return !identity.empty() || any_file(); }

  /// That the database is no good for it, for it `is` so.
  Error refused(const std::string& is) const {
    return {Reason::storage,
            "the data folder " + folder + " has " +
                count(of(FileKind::mesh).size(), "mesh", "meshes") + ", " +
                count(of(FileKind::result).size(), "result", "results") + " and " +
                count(of(FileKind::upload).size(), "upload", "uploads") + " of a store, but " +
                database_path(folder) + " " + is +
                ": restore the database of that store from a backup, or move the folder away to "
                "start anew"};
  }

  std::string folder;
  std::string identity;
  std::array<std::vector<std::string>, file_kinds.size()> files;
};

bool names_one(Connection& connection, const Left& left) {
  return std::ranges::any_of(file_kinds, [&](FileKind kind) {
    return std::ranges::any_of(left.of(kind), [&](const std::string& name) {
      return is_referenced(connection, kind, name);
    });
  });
}

}  // namespace

void require_database(const std::string& folder) {
  const std::optional<std::uint64_t> bytes = file_size(database_path(folder));
  if (bytes.value_or(0) > 0) {
    return;
  }
  if (const Left left(folder); left.anything()) {
    throw left.refused(bytes ? "is empty" : "is missing");
  }
}

void require_own(Connection& connection, const std::string& folder) {
  const Left left(folder);
  if (connection.integer("PRAGMA user_version") == 0) {
    if (left.anything()) {
      throw left.refused("is empty");
    }
    return;
  }
  const std::string identity = identity_in(connection);
  if (!identity.empty() && !left.identity.empty()) {
    if (identity != left.identity) {
      throw left.refused("is another store's (" + identity + ", not " + left.identity + ")");
    }
  } else if (left.any_file() && !names_one(connection, left)) {
    throw left.refused("names none of them");
  }
}

void keep_identity(Connection& connection, const std::string& folder) {
  const std::string identity = identity_in(connection);
  if (identity != identity_in(folder)) {
    replace_file(identity_path(folder), std::as_bytes(std::span(identity)));
  }
}

}  // namespace anticrack::store
