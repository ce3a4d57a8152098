// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/schema.hpp"

namespace anticrack::postgres {

namespace {

using errors::Error;
using errors::Reason;

/// Of the advisory lock under which tables are made; any number that no other program takes.
constexpr std::int64_t making = 0x616e7469637261;

}  // namespace

void make_tables(Pool& pool, const Tables& tables) {
  const auto ours = static_cast<std::int64_t>(tables.steps.size());
  transact(pool, [&](Transaction& transaction) {
    transaction.run("SELECT pg_advisory_xact_lock($1)", {making});
    if (transaction.run("SELECT 1 FROM pg_namespace WHERE nspname = 'anticrack'").empty())
      transaction.run("CREATE SCHEMA anticrack");
    std::int64_t version = 0;
    if (!transaction.run("SELECT 1 WHERE to_regclass('anticrack.tables') IS NOT NULL").empty()) {
      const Result found = transaction.run("SELECT version, oldest FROM tables");
      version = found.integer(0, 0);
      if (found.integer(0, 1) > ours) {
        throw Error(
            Reason::storage,
            "the PostgreSQL database {} has tables of version {}, this anticrack knows "
            "version {}: start the newer anticrack that made them, or give another database",
            pool.settings().address.shown(), version, ours);
      }
    } else {
      transaction.run("CREATE TABLE tables (version bigint NOT NULL, oldest bigint NOT NULL)");
      transaction.run("INSERT INTO tables VALUES (0, 0)");
    }
    if (version >= ours) return;
    for (std::int64_t step = version; step < ours; ++step)
      transaction.execute(tables.steps[static_cast<std::size_t>(step)]);
    transaction.run("UPDATE tables SET version = $1, oldest = $2", {ours, tables.oldest});
  });
}

}  // namespace anticrack::postgres
