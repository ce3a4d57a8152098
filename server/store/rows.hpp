// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows of the database: checks that they are as they were written, and reads what they hold. Every
// call throws as Connection does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "store/disk_usage.hpp"
#include "store/sqlite.hpp"

namespace anticrack::records {
struct JobRecord;
struct MeshRecord;
}  // namespace anticrack::records

namespace anticrack::store {

/// A table, whose records refer to files of one kind.
struct Table {
  std::string name;
  std::string id;        ///< column
  std::string file;      ///< column; empty in a row: no file
  std::string checksum;  ///< SQL: what the column checksum must be, without small results
  std::string record;    ///< SQL
};
const Table& table_of(FileKind kind);

struct Row {
  std::string id;
  std::string owner;
  bool intact = false;  ///< its checksum is right
  std::string record;   ///< empty for an upload
  std::string file;
};

/// SQL: SELECT with the columns of a row.
std::string select_rows(FileKind kind);
/// The present row of a statement with these columns; all its rows.
Row row_at(Statement& select);
std::vector<Row> rows_at(Statement&& select);
/// The row of a mesh or job; empty if there is none.
std::optional<Row> find_row(Connection& connection, FileKind kind, const std::string& id);

/// Throws errors::Error (storage) with the record's name if the row's checksum is wrong.
void require_intact(const Row& row, FileKind kind);
/// The record in a row. Throws as require_intact does, also if the bytes are no record.
records::MeshRecord read_mesh(const Row& row);
records::JobRecord read_job(const Row& row);
/// The same, but a damaged record comes as FAILED with that error, and only its id and owner are
/// known.
records::MeshRecord mesh_of(const Row& row);
records::JobRecord job_of(const Row& row);
std::vector<records::JobRecord> jobs_of(const std::vector<Row>& rows);

/// Whether a row refers to the file. `by_rows`: reads the rows instead of an index, in O(rows).
bool is_referenced(Connection& connection, FileKind kind, const std::string& sha256,
                   bool by_rows = false);

/// Reads every row; returns whether the checksums of all are right.
bool all_intact(Connection& connection);

}  // namespace anticrack::store
