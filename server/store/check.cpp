// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/check.hpp"

#include <map>
#include <optional>

#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/files.hpp"
#include "store/identity.hpp"
#include "store/result_file.hpp"
#include "store/rows.hpp"
#include "store/schema.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;
using Name = CheckedStore::Name;

class Check {
 public:
  explicit Check(const std::string& folder) : _folder(folder) {
    attempt([&] { require_database(_folder); });
    if (file_size(database_path(_folder)).value_or(0) > 0) {
      attempt([&] { _database.emplace(database_path(_folder)); });
      attempt([&] { look_at_database(); });
    }
    if (found.has_database) {
      require_version(*_database);
      for (const FileKind kind : file_kinds)
        if (!attempt([&] { look_at_rows(kind); }))
          return;  // without the rows, files cannot be told apart
    }
    for (const FileKind kind : file_kinds) look_at_files(kind);
    for (const auto& [file, owner] : _named) {
      flaw(path_of(file) + " of " + owner + " is missing");
      found.lost.insert(file);
    }
  }

  CheckedStore found;

 private:
  void flaw(const std::string& text) { found.flaws.push_back(text); }

  /// Calls `look` and notes what it throws as a flaw. Returns whether it threw nothing.
  template <class Look>
  bool attempt(const Look& look) {
    try {
      look();
      return true;
    } catch (const Error& error) {
      flaw(error.what());
      return false;
    }
  }

  std::string path_of(const Name& file) const {
    return folder_of(_folder, file.first) + "/" + file.second;
  }

  void look_at_database() {
    found.has_database = _database->integer("PRAGMA user_version") > 0;
    attempt([&] { require_own(*_database, _folder); });
    Statement lines = _database->prepare("PRAGMA integrity_check(20)");
    while (lines.step())
      if (lines.text(0) != "ok") flaw("the database " + _database->path() + ": " + lines.text(0));
  }

  void look_at_rows(FileKind kind) {
    Statement select = _database->prepare(select_rows(kind));
    while (select.step()) {
      ++found.records;
      const Row row = row_at(select);
      if (!attempt([&] { look_at(row, kind); }))
        found.damaged.emplace(kind, row.id);
      else if (!row.file.empty())
        _named.emplace(Name{kind, row.file}, table_of(kind).name + "/" + row.id);
    }
  }

  void look_at(const Row& row, FileKind kind) {
    require_intact(row, kind);
    if (kind == FileKind::mesh) {
      read_mesh(row);
    } else if (kind == FileKind::result) {
      read_job(row);
      Statement select = _database->prepare(
          "SELECT small_result FROM jobs WHERE id = ? AND result = '' AND result_bytes > 0");
      if (select.bind(row.id).step()) open_result(select.text(0), "the row of jobs/" + row.id);
    }
  }

  void look_at_files(FileKind kind) {
    for (const std::string& name : file_names(folder_of(_folder, kind))) {
      ++found.files;
      const Name file{kind, name};
      if (_named.erase(file) == 0) {
        flaw(path_of(file) + " belongs to no record");
        found.spare.insert(file);
      } else if (!attempt([&] { require_whole_file(file); })) {
        found.spare.insert(file);
        found.lost.insert(file);
      }
    }
  }

  void require_whole_file(const Name& file) const {
    const std::string path = path_of(file);
    if (file.first == FileKind::result)
      require_whole(*open_result(open_to_read(path), path, file.second), path);
    else if (sha256_of(path) != file.second)
      throw Error(Reason::storage, "{} is damaged: its content has another hash", path);
  }

  const std::string& _folder;
  std::optional<Connection> _database;
  std::map<Name, std::string> _named;  ///< files of records that were not seen yet
};

}  // namespace

CheckedStore check(const std::string& folder) { return Check(folder).found; }

}  // namespace anticrack::store
