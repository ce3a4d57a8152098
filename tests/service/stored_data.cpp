// SPDX-License-Identifier: GPL-3.0-or-later
#include "service/stored_data.hpp"

#include <sqlite3.h>

#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>

namespace anticrack::service_test {
namespace {

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Names = std::set<std::string>;

Database open(const std::string& path) {
  sqlite3* database = nullptr;
  // Not read-only: what is left of a write-ahead log is to be seen too.
  const int code = sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr);
  Database result(database, &sqlite3_close);
  if (code != SQLITE_OK) throw std::runtime_error("cannot open " + path);
  return result;
}

Names column(sqlite3* database, const std::string& sql) {
  Names rows;
  const auto add = [](void* target, int, char** texts, char**) {
    static_cast<Names*>(target)->insert(texts[0] == nullptr ? "" : texts[0]);
    return 0;
  };
  char* message = nullptr;
  if (sqlite3_exec(database, sql.c_str(), add, &rows, &message) != SQLITE_OK) {
    const std::string text = message == nullptr ? "no message" : message;
    sqlite3_free(message);
    throw std::runtime_error(sql + ": " + text);
  }
  return rows;
}

void compare(const std::string& folder, const Names& wanted, std::vector<std::string>& flaws) {
  Names there;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    there.insert(entry.path().filename());
  }
  for (const std::string& name : there) {
    if (!wanted.contains(name)) flaws.push_back(folder + "/" + name + " belongs to nothing");
  }
  for (const std::string& name : wanted) {
    if (!there.contains(name)) flaws.push_back(folder + "/" + name + " is missing");
  }
}

}  // namespace

std::vector<std::string> flaws_of(const std::string& data) {
  std::vector<std::string> flaws;
  const Database database = open(data + "/anticrack.db");
  for (const std::string& line : column(database.get(), "PRAGMA integrity_check")) {
    if (line != "ok") flaws.push_back("database: " + line);
  }
  compare(data + "/meshes", column(database.get(), "SELECT sha256 FROM meshes WHERE sha256 <> ''"),
          flaws);
  compare(data + "/results", column(database.get(), "SELECT result FROM jobs WHERE result <> ''"),
          flaws);
  compare(data + "/uploads", column(database.get(), "SELECT sha256 FROM uploads"), flaws);
  return flaws;
}

}  // namespace anticrack::service_test
