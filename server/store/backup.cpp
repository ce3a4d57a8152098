// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/backup.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <set>
#include <utility>

#include "digest/digest.hpp"
#include "store/disk_errors.hpp"
#include "store/files.hpp"
#include "store/identity.hpp"
#include "store/rows.hpp"
#include "store/schema.hpp"

namespace anticrack::store {

namespace {

namespace fs = std::filesystem;
using errors::Error;
using errors::Reason;

/// How many snapshots of the database to try before a missing file counts as lost.
constexpr int most_attempts = 10;

/// Links or copies a file, unless `to` exists already. Returns false if there is no such file.
bool link_or_copy(const std::string& from, const std::string& to) {
  if (::link(from.c_str(), to.c_str()) == 0 || errno == EEXIST) return true;
  if (errno == ENOENT) return false;
  // This file system may be another one or have no links, or links to others' files are forbidden.
  std::error_code code;
  fs::copy_file(from, to, code);
  if (code == std::errc::no_such_file_or_directory) return false;
  if (code) throw disk_error("copy " + from, code.value());
  flush(to);
  return true;
}

class Backup {
 public:
  Backup(const std::string& data, const std::string& to) : _data(data), _to(to) {
    if (::mkdir(_to.c_str(), S_IRWXU) != 0) {
      if (errno == EEXIST) {
        throw Error(Reason::invalid_argument,
                    "{} is what an interrupted backup left: remove it and try again", _to);
      }
      throw disk_error("make the folder " + _to, errno);
    }
  }
  /// Removes an incomplete copy, which is of no use.
  ~Backup() {
    if (!_complete) {
      std::error_code ignored;
      fs::remove_all(_to, ignored);
    }
  }
  Backup(const Backup&) = delete;
  Backup& operator=(const Backup&) = delete;

  BackedUp make() {
    for (const FileKind kind : file_kinds) make_folder(folder_of(_to, kind));
    std::string missing;
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
      // The server may remove a file to which the snapshot refers. All present files are linked
      // before the snapshot, so that only a file that comes and goes meanwhile needs another
      // attempt.
      link_all_files();
      copy_records();
      missing = link_named_files();
      if (missing.empty()) return finished();
    }
    throw Error(Reason::storage,
                "{} is missing, though a record refers to it: stop the server and run anticrackd "
                "--check-store --repair, then back up",
                missing);
  }

 private:
  void link_all_files() const {
    for (const FileKind kind : file_kinds)
      for (const std::string& name : file_names(folder_of(_data, kind))) link(kind, name);
  }

  bool link(FileKind kind, const std::string& name) const {
    return link_or_copy(folder_of(_data, kind) + "/" + name, folder_of(_to, kind) + "/" + name);
  }

  void copy_records() {
    const std::string path = database_path(_to);
    ::unlink(path.c_str());
    {
      Connection source(database_path(_data));
      require_version(source);
      source.run("VACUUM INTO ?", path);
    }
    Connection copy(path);
    copy.execute("UPDATE store SET stopped = 1");  // a server that starts from it has not crashed
    keep_identity(copy, _to);
    _named.clear();
    for (const FileKind kind : file_kinds) {
      const Table& table = table_of(kind);
      Statement select = copy.prepare("SELECT " + table.file + " FROM " + table.name + " WHERE " +
                                      table.file + " <> ''");
      while (select.step()) _named.emplace(kind, select.text(0));
    }
  }

  /// Links the files that the records name; returns the path of a missing one, or an empty text.
  std::string link_named_files() const {
    for (const auto& [kind, name] : _named) {
      if (!digest::is_sha256(name)) continue;  // a damaged row, which --check-store will find
      if (!link(kind, name)) return folder_of(_data, kind) + "/" + name;
    }
    return {};
  }

  BackedUp finished() {
    BackedUp made;
    for (const FileKind kind : file_kinds) {
      const std::string folder = folder_of(_to, kind);
      for (const std::string& name : file_names(folder)) {
        const std::string path = folder + "/" + name;
        if (!_named.contains({kind, name})) {
          if (::unlink(path.c_str()) != 0) throw disk_error("remove " + path, errno);
          continue;
        }
        ++made.files;
        made.bytes += file_size(path).value_or(0);
      }
      flush(folder);
    }
    made.bytes += file_size(database_path(_to)).value_or(0);
    flush(database_path(_to));
    flush(_to);
    _complete = true;
    return made;
  }

  const std::string& _data;
  const std::string& _to;
  std::set<std::pair<FileKind, std::string>> _named;
  bool _complete = false;
};

}  // namespace

BackedUp back_up(const std::string& data, const std::string& to) {
  fs::path path = fs::absolute(to).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const std::string whole = path.string();
  std::error_code code;
  if (fs::exists(fs::symlink_status(path, code))) {
    throw Error(Reason::invalid_argument, "{} exists already: name a new folder for a backup",
                whole);
  }
  if (file_size(database_path(data)).value_or(0) == 0) {
    throw Error(Reason::invalid_argument,
                "{} has no database: say where the data is with --data-dir", data);
  }
  const std::string partial = whole + ".partial";
  BackedUp made = Backup(data, partial).make();
  if (::rename(partial.c_str(), whole.c_str()) != 0) throw disk_error("rename " + partial, errno);
  flush(path.parent_path().string());
  made.folder = whole;
  return made;
}

}  // namespace anticrack::store
