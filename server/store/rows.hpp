// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows of the database: whether they are as they were written, what they hold and refer to. Every
// call throws as Connection does.
#pragma once

#include <optional>
#include <string>

#include "records/records.hpp"
#include "store/disk_usage.hpp"
#include "store/sqlite.hpp"

namespace anticrack::store {

/// The table whose records refer to files of a kind.
struct Table {
  std::string name;
  std::string id;    ///< column
  std::string file;  ///< column; empty in a row: no file
  std::string
      checksum;        ///< SQL: what the column checksum must be. Of all others but a small result
  std::string record;  ///< SQL
};
const Table& table_of(FileKind kind);

struct Row {
  std::string id;
  std::string owner;
  bool intact = false;  ///< has its checksum
  std::string record;   ///< none of an upload
  std::string file;
};

/// SQL: SELECT with the columns of a row.
std::string select_rows(FileKind kind);
/// The row that a statement of these columns is at.
Row row_at(Statement& select);
/// The row of a mesh or job; empty where there is none.
std::optional<Row> find_row(Connection& connection, FileKind kind, const std::string& id);

/// Throws errors::Error (storage) with the record's name where the row has not its checksum.
void require_intact(const Row& row, FileKind kind);
/// The record in a row. Throws as require_intact does, also where it is none.
records::MeshRecord read_mesh(const Row& row);
records::JobRecord read_job(const Row& row);
/// The same, but what is damaged is FAILED with that error; no more is known of it than id and
/// owner.
records::MeshRecord mesh_of(const Row& row);
records::JobRecord job_of(const Row& row);

/// Whether a row refers to the file. `by_rows`: without trust in any index, in O(rows).
bool is_referenced(Connection& connection, FileKind kind, const std::string& sha256,
                   bool by_rows = false);

/// Reads every row: whether all have their checksums.
bool all_intact(Connection& connection);

}  // namespace anticrack::store
