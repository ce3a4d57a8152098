// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/durable_store.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "store/identity.hpp"
#include "store/rows.hpp"
#include "store/schema.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

std::string made(const std::string& folder) {
  make_folder(folder);
  return folder;
}

Connection open_writer(const std::string& folder) {
  require_database(folder);
  Connection connection(database_path(folder));
  {
    Statement mode = connection.prepare("PRAGMA journal_mode = WAL");
    if (!mode.step() || mode.text(0) != "wal") {
      throw Error(Reason::storage,
                  "the file system of {} cannot share memory between programs (SQLite's WAL): put "
                  "the data folder on a local disk",
                  folder);
    }
  }
  connection.execute(
      "PRAGMA synchronous = FULL; PRAGMA temp_store = MEMORY; "
      "PRAGMA journal_size_limit = 67108864");
  require_sound(connection);
  require_own(connection, folder);
  make_tables(connection);
  {
    // This finds a database that can only be read, which SQLite would take while the connection
    // lives.
    const Transaction probe(connection);
  }
  flush(folder);
  keep_identity(connection, folder);
  return connection;
}

Connection open_reader(const std::string& folder) {
  Connection connection(database_path(folder));
  connection.execute("PRAGMA query_only = ON; PRAGMA temp_store = MEMORY");
  return connection;
}

}  // namespace

DurableStore::DurableStore(const StoreOptions& options)
    : CommonStore(made(options.folder), options.disk_budget),
      _folder(options.folder),
      _meshes(_folder, FileKind::mesh, _usage),
      _writer(open_writer(_folder),
              [this](Connection& connection) { remove_unreferenced(connection); }),
      _reader(open_reader(_folder)) {
  std::vector<FileName> spare;
  for (const FileKind kind : file_kinds)
    for (std::string& name : files(kind).sweep(
             [&](const std::string& sha256) { return is_referenced(_reader, kind, sha256); }))
      spare.push_back({kind, std::move(name)});
  // A damaged index may lack names that its rows have, and a damaged row may have named anything.
  if (!spare.empty() && all_intact(_reader)) {
    for (const auto& [kind, sha256] : spare)
      if (!is_referenced(_reader, kind, sha256, true)) files(kind).remove(sha256);
  }
}

Files& DurableStore::files(FileKind kind) {
  switch (kind) {
    case FileKind::mesh:
      return _meshes;
    case FileKind::result:
      return _results;
    case FileKind::upload:
      break;
  }
  return _uploads;
}

std::uint64_t DurableStore::database_bytes() const {
  std::uint64_t bytes = 0;
  for (const char* suffix : {"", "-wal", "-shm"})
    bytes += file_size(database_path(_folder) + suffix).value_or(0);
  return bytes;
}

DiskUsage::Reservation DurableStore::reserve(std::uint64_t bytes) {
  return _usage.reserve(bytes, database_bytes());
}

void DurableStore::remove_unreferenced(Connection& connection) {
  while (!_unreferenced.empty()) {
    const auto& [kind, sha256] = _unreferenced.back();
    if (!is_referenced(connection, kind, sha256)) {
      if (kind == FileKind::mesh) _triangulations.forget(sha256);
      files(kind).remove(sha256);
    }
    _unreferenced.pop_back();
  }
}

std::optional<Row> DurableStore::row(FileKind kind, const std::string& id) const {
  return reading([&](Connection& connection) { return find_row(connection, kind, id); });
}

std::vector<Row> DurableStore::page(FileKind kind, const Page& page) const {
  const std::string& table = table_of(kind).name;
  const std::string of_owner = page.owner ? " AND owner = ?" : "";
  return reading([&](Connection& connection) {
    std::int64_t last = page.oldest_first ? 0 : std::numeric_limits<std::int64_t>::max();
    if (!page.after.empty()) {
      Statement select =
          connection.prepare("SELECT number FROM " + table + " WHERE id = ?" + of_owner);
      select.bind(page.after);
      if (page.owner) select.bind(*page.owner);
      if (!select.step()) throw unknown(table, page.after);
      last = select.integer(0);
    }
    Statement select = connection.prepare(
        select_rows(kind) + " WHERE number " + (page.oldest_first ? ">" : "<") + " ?" + of_owner +
        " ORDER BY number " + (page.oldest_first ? "" : "DESC ") + "LIMIT ?");
    select.bind(last);
    if (page.owner) select.bind(*page.owner);
    constexpr std::size_t most = std::numeric_limits<std::int64_t>::max();
    select.bind(static_cast<std::int64_t>(std::min(page.count, most)));
    return rows_at(std::move(select));
  });
}

Usage DurableStore::usage() const {
  return {_usage.bytes(FileKind::mesh), _usage.bytes(FileKind::result),
          _usage.bytes(FileKind::upload), database_bytes()};
}

std::vector<OwnerUsage> DurableStore::owners() const {
  return reading([](Connection& connection) {
    Statement select = connection.prepare(
        "SELECT owner, count(*), sum(ended IS NULL), sum(result_bytes) FROM jobs GROUP BY owner");
    std::vector<OwnerUsage> owners;
    while (select.step())
      owners.push_back({select.text(0), static_cast<std::uint64_t>(select.integer(1)),
                        static_cast<std::uint64_t>(select.integer(2)),
                        static_cast<std::uint64_t>(select.integer(3))});
    return owners;
  });
}

std::unique_ptr<Store> open(const StoreOptions& options) {
  return std::make_unique<DurableStore>(options);
}

}  // namespace anticrack::store
