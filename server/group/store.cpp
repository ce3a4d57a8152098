// SPDX-License-Identifier: GPL-3.0-or-later
#include "group/store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <random>
#include <span>

#include "errors/errors.hpp"
#include "group/blobs.hpp"
#include "group/rows.hpp"
#include "group/tables.hpp"
#include "store/record_codec.hpp"
#include "store/requests.hpp"

namespace anticrack::group {

namespace {

using errors::Error;
using errors::Reason;
using postgres::Result;

/// The folder, for a server on a database: all files in it are removed at each start.
std::string own_folder(const std::string& folder) {
  if (store::file_size(store::database_path(folder))) {
    throw Error(Reason::storage,
                "the data folder {} is a store of its own, of a server without --store: give "
                "another --data-dir",
                folder);
  }
  store::make_folder(folder);
  return folder;
}

/// The name of the server of this data folder, made at its first start.
std::string name_of(const std::string& folder) {
  const std::string path = folder + "/server";
  std::string name;
  if (std::ifstream(path) >> name) return name;
  std::random_device random;
  name = fmt::format("{:08x}{:08x}", random(), random());
  store::replace_file(path, std::as_bytes(std::span(name)));
  return name;
}

}  // namespace

postgres::Settings settings_of(const std::string& url) {
  postgres::Settings settings{postgres::Address(url)};
  for (const postgres::Options& server : settings.address.servers())
    if (server.contains("password"))
      throw Error(Reason::invalid_argument,
                  "there is a password in the address, where others see it: give it in ~/.pgpass, "
                  "PGPASSFILE or PGPASSWORD");
  return settings;
}

Store::Store(const store::StoreOptions& options)
    : CommonStore(own_folder(options.folder), options.disk_budget),
      _pool([&] {
        postgres::Settings settings = settings_of(options.url);
        settings.answered = options.answered;
        return settings;
      }()),
      _queue((postgres::make_tables(_pool, tables()), _pool), name_of(options.folder)) {
  for (store::Files* files : {&_results, &_uploads})
    for (const std::string& name : files->sweep([](const std::string&) { return false; }))
      files->remove(name);
}

std::optional<store::Row> Store::row(store::FileKind kind, const std::string& id) const {
  const Result rows = postgres::query(
      _pool,
      fmt::format("SELECT {} FROM {} WHERE id = $1", row_columns, store::table_of(kind).name),
      {id});
  return rows.empty() ? std::nullopt : std::optional(row_at(rows, 0));
}

std::vector<store::Row> Store::page(store::FileKind kind, const store::Page& page) const {
  const std::string& table = store::table_of(kind).name;
  const std::string owner = to_column(page.owner.value_or(""));
  std::int64_t last = page.oldest_first ? 0 : std::numeric_limits<std::int64_t>::max();
  if (!page.after.empty()) {
    const Result after = postgres::query(
        _pool, fmt::format("SELECT number FROM {} WHERE id = $1 AND (NOT $2 OR owner = $3)", table),
        {page.after, page.owner.has_value(), owner});
    if (after.empty()) throw store::unknown(table, page.after);
    last = after.integer(0, 0);
  }
  constexpr std::size_t most = std::numeric_limits<std::int64_t>::max();
  const std::string select =
      fmt::format("SELECT {} FROM {} WHERE number {} $1 {} ORDER BY number {} LIMIT $2",
                  row_columns, table, page.oldest_first ? ">" : "<",
                  page.owner ? "AND owner = $3" : "", page.oldest_first ? "" : "DESC");
  const std::size_t count = std::min(page.count, most);
  return rows_at(page.owner ? postgres::query(_pool, select, {last, count, owner})
                            : postgres::query(_pool, select, {last, count}));
}

std::vector<std::string> Store::erase(const char* table, const char* blob, const std::string& id) {
  std::vector<std::string> removed;
  transact(_pool, [&](postgres::Transaction& transaction) {
    const Result erased = transaction.run(
        fmt::format("DELETE FROM {} WHERE id = $1 RETURNING {}", table, blob), {id});
    if (!erased.empty())
      removed = remove_unreferenced(transaction, {erased.text(0, 0)});
    else if (!transaction.repeated())
      throw store::unknown(table, id);
  });
  return removed;
}

store::Usage Store::usage() const {
  store::Usage usage;
  const Result sums =
      postgres::query(_pool, "SELECT kind, sum(bytes)::bigint FROM blobs GROUP BY kind");
  for (std::size_t row = 0; row < sums.rows(); ++row) {
    const std::uint64_t bytes = sums.count(row, 1);
    switch (static_cast<store::FileKind>(sums.integer(row, 0))) {
      case store::FileKind::mesh:
        usage.meshes = bytes;
        break;
      case store::FileKind::result:
        usage.results = bytes;
        break;
      case store::FileKind::upload:
        usage.uploads = bytes;
        break;
    }
  }
  usage.database = postgres::query(_pool,
                                   "SELECT greatest(0, pg_database_size(current_database()) - "
                                   "pg_total_relation_size('pieces'))")
                       .count(0, 0);
  return usage;
}

std::vector<store::OwnerUsage> Store::owners() const {
  const Result rows =
      postgres::query(_pool,
                      "SELECT owner, count(*), count(*) FILTER (WHERE ended IS NULL), "
                      "sum(result_bytes)::bigint FROM jobs GROUP BY owner");
  return rows.each([&](std::size_t row) {
    return store::OwnerUsage{of_column(rows.view(row, 0)), rows.count(row, 1), rows.count(row, 2),
                             rows.count(row, 3)};
  });
}

std::optional<store::GroupState> Store::group() const {
  const std::int64_t now = store::to_disk(records::Clock::now());
  const Result row = postgres::query(
      _pool,
      "SELECT s.*, q.*, (extract(epoch FROM clock_timestamp()) * 1000000000)::bigint FROM "
      "(SELECT count(*) FILTER (WHERE NOT dead), count(*) FILTER (WHERE dead) FROM servers) s, "
      "(SELECT count(*) FILTER (WHERE runner IS NULL), count(runner), coalesce((extract(epoch "
      "FROM now() - min(queued) FILTER (WHERE runner IS NULL)) * 1000)::bigint, 0) FROM queue) q");
  const double wait = static_cast<double>(row.integer(0, 4)) * 1e-3,
               offset = static_cast<double>(row.integer(0, 5) - now) * 1e-9;
  return store::GroupState{row.count(0, 0), row.count(0, 1), row.count(0, 2), row.count(0, 3), wait,
                           offset};
}

}  // namespace anticrack::group
