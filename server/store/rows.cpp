// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/rows.hpp"

#include <algorithm>

#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/record_codec.hpp"

namespace anticrack::store {

namespace {

using errors::Error;

Error damaged(const Row& row, FileKind kind, const Error& error) {
  return {error.reason(), table_of(kind).name + "/" + row.id + ": " + error.what()};
}

template <class Decode>
auto read(const Row& row, FileKind kind, const Decode& decode) {
  require_intact(row, kind);
  try {
    auto record = decode(row.record);
    if (record.id != row.id) throw damaged_record("it belongs to " + record.id);
    return record;
  } catch (const Error& error) {
    throw damaged(row, kind, error);
  }
}

template <class Record>
Record record_of(const Row& row, Record (*read)(const Row&)) {
  try {
    return read(row);
  } catch (const Error& error) {
    Record lost;
    lost.id = row.id;
    lost.owner = row.owner;
    lost.state = decltype(lost.state)::failed;
    lost.error = error;
    return lost;
  }
}

}  // namespace

const Table& table_of(FileKind kind) {
  static const std::array<Table, file_kinds.size()> tables{{
      {"meshes", "id", "sha256", "crc32c(id, owner, sha256, upload, record)", "record"},
      {"jobs", "id", "result",
       "crc32c(id, owner, request, fingerprint, ended, result, result_bytes, record)", "record"},
      {"uploads", "sha256", "sha256", "crc32c(sha256, owner, created)", "NULL"},
  }};
  return tables[static_cast<std::size_t>(kind)];
}

std::string select_rows(FileKind kind) {
  const Table& table = table_of(kind);
  return "SELECT " + table.id + ", owner, checksum IS " + table.checksum + ", " + table.record +
         ", " + table.file + " FROM " + table.name;
}

Row row_at(Statement& select) {
  return {select.text(0), select.text(1), select.integer(2) != 0, select.text(3), select.text(4)};
}

std::vector<Row> rows_at(Statement&& select) {
  std::vector<Row> rows;
  while (select.step()) rows.push_back(row_at(select));
  return rows;
}

std::optional<Row> find_row(Connection& connection, FileKind kind, const std::string& id) {
  Statement select = connection.prepare(select_rows(kind) + " WHERE id = ?");
  if (!select.bind(id).step()) return std::nullopt;
  Row row = row_at(select);
  row.id = id;  // a damaged index may lead to another row
  return row;
}

void require_intact(const Row& row, FileKind kind) {
  if (!row.intact) throw damaged(row, kind, damaged_record("its checksum is wrong"));
}

records::MeshRecord read_mesh(const Row& row) {
  return read(row, FileKind::mesh, decode_mesh_record);
}

records::JobRecord read_job(const Row& row) {
  return read(row, FileKind::result, decode_job_record);
}

records::MeshRecord mesh_of(const Row& row) { return record_of(row, read_mesh); }

records::JobRecord job_of(const Row& row) { return record_of(row, read_job); }

std::vector<records::JobRecord> jobs_of(const std::vector<Row>& rows) {
  std::vector<records::JobRecord> records;
  records.reserve(rows.size());
  for (const Row& row : rows) records.push_back(job_of(row));
  return records;
}

bool is_referenced(Connection& connection, FileKind kind, const std::string& sha256, bool by_rows) {
  const Table& table = table_of(kind);
  return connection.any("SELECT 1 FROM " + table.name + (by_rows ? " NOT INDEXED" : "") +
                            " WHERE " + table.file + " = ? AND " + table.file + " <> '' LIMIT 1",
                        sha256);
}

bool all_intact(Connection& connection) {
  return std::ranges::none_of(file_kinds, [&](FileKind kind) {
    const Table& table = table_of(kind);
    return connection.any("SELECT 1 FROM " + table.name + " WHERE checksum IS NOT " +
                          table.checksum + " LIMIT 1");
  });
}

}  // namespace anticrack::store
