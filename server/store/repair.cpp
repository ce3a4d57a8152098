// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>

#include "store/check.hpp"
#include "store/disk_errors.hpp"
#include "store/files.hpp"
#include "store/rows.hpp"
#include "store/schema.hpp"

namespace anticrack::store {

namespace {

std::string make_new_folder(const std::string& folder) {
  for (int number = 1;; ++number) {
    std::string path = fmt::format("{}/set-aside-{}", folder, number);
    if (::mkdir(path.c_str(), S_IRWXU) == 0) return path;
    if (errno != EEXIST) throw disk_error("make the folder " + path, errno);
  }
}

/// Moves a file, if it exists.
void move(const std::string& name, const std::string& from, const std::string& to) {
  make_folder(to);
  if (std::rename((from + "/" + name).c_str(), (to + "/" + name).c_str()) != 0 && errno != ENOENT)
    throw disk_error("rename " + from + "/" + name, errno);
  flush(to);
  flush(from);
}

void remove_records(Connection& connection, const CheckedStore& checked) {
  Transaction transaction(connection);
  connection.execute("REINDEX");  // a row that differs from its index cannot be removed
  const auto remove = [&](const CheckedStore::Name& name, const std::string& column) {
    connection.run("DELETE FROM " + table_of(name.first).name + " WHERE " + column + " = ?",
                   name.second);
  };
  for (const CheckedStore::Name& record : checked.damaged)
    remove(record, table_of(record.first).id);
  for (const CheckedStore::Name& file : checked.lost) remove(file, table_of(file.first).file);
  connection.execute("DELETE FROM job_uploads WHERE job NOT IN (SELECT number FROM jobs)");
  transaction.commit();
}

}  // namespace

std::string repair(const std::string& folder, const CheckedStore& checked) {
  std::optional<Connection> database;
  if (checked.has_database) require_sound(database.emplace(database_path(folder)));
  const std::string aside = make_new_folder(folder);
  for (const auto& [kind, name] : checked.spare)
    move(name, folder_of(folder, kind), folder_of(aside, kind));
  move("identity", folder, aside);  // the next start takes that of the database, or makes another
  if (database) {
    const std::string copy = database_path(aside);
    database->run("VACUUM INTO ?", copy);
    flush(copy);
    remove_records(*database, checked);
  } else {
    for (const char* name : {"anticrack.db", "anticrack.db-wal", "anticrack.db-shm"})
      move(name, folder, aside);
  }
  return aside;
}

}  // namespace anticrack::store
