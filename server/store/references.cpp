// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/references.hpp"

namespace anticrack::store {

bool is_referenced(Connection& connection, FileKind kind, const std::string& sha256) {
  const char* sql = "";
  switch (kind) {
    case FileKind::mesh:
      sql = "SELECT 1 FROM meshes WHERE sha256 = ? AND sha256 <> '' LIMIT 1";
      break;
    case FileKind::result:
      sql = "SELECT 1 FROM jobs WHERE result = ? AND result <> '' LIMIT 1";
      break;
    case FileKind::upload:
      sql = "SELECT 1 FROM uploads WHERE sha256 = ? LIMIT 1";
      break;
  }
  return connection.prepare(sql).bind(std::string_view(sha256)).step();
}

}  // namespace anticrack::store
