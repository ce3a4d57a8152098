// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests of what store.hpp promises, with every store there is.
#pragma once

#include <fmt/core.h>

#include "store/files.hpp"
#include "store/queue.hpp"
#include "store/store_fixture.hpp"
#ifdef ANTICRACK_POSTGRESQL
#include "postgres/pool.hpp"
#include "support/database.hpp"
#endif

namespace anticrack::store {

enum class Backend { sqlite, postgresql };

#ifdef ANTICRACK_POSTGRESQL
inline const auto stores = ::testing::Values(Backend::sqlite, Backend::postgresql);

inline std::string fresh_database() { return anticrack::testing::shared_database().fresh(); }

inline postgres::Result ask(const std::string& url, const std::string& sql) {
  postgres::Pool pool({postgres::Address(url), "test"});
  return postgres::query(pool, sql);
}
#else
inline const auto stores = ::testing::Values(Backend::sqlite);
inline std::string fresh_database() { return {}; }
#endif

inline std::string name_of_store(const ::testing::TestParamInfo<Backend>& given) {
  return given.param == Backend::sqlite ? "SQLite" : "PostgreSQL";
}

/// The tests are run by a server alone, which has the jobs it makes; those that it made before it
/// started again it takes up as attempt().
class ContractTest : public StoreTest, public ::testing::WithParamInterface<Backend> {
 protected:
  ContractTest() : StoreTest(GetParam() == Backend::sqlite ? std::string() : fresh_database()) {}

  /// Why a job cannot be written that was erased.
  errors::Reason gone() const {
    return store->queue() == nullptr ? errors::Reason::not_found : errors::Reason::in_use;
  }
  /// As which attempt a job goes on after another start.
  int attempt(const std::string& id) const {
    Queue* const queue = store->queue();
    if (queue == nullptr) return store->job(id)->attempt;
    queue->beat({});  // frees what the earlier start had
    return queue->claim_to_cancel(id).value().record.attempt;
  }
  /// Ends a job of an earlier start.
  void end_later(const std::string& id) {
    records::JobRecord record = ended_record(id);
    record.attempt = attempt(id);
    store->finish(record, nullptr);
  }
  /// How many triangulations, results or uploads are stored.
  std::size_t blobs(FileKind kind) const {
#ifdef ANTICRACK_POSTGRESQL
    if (!url.empty()) {
      const postgres::Result counts = ask(
          url, fmt::format("SELECT count(*), (SELECT count(*) FROM pieces WHERE n = 0 AND sha256 "
                           "NOT IN (SELECT sha256 FROM blobs)) FROM blobs WHERE kind = {}",
                           static_cast<int>(kind)));
      EXPECT_EQ(counts.integer(0, 1), 0) << "pieces of nothing";
      return static_cast<std::size_t>(counts.integer(0, 0));
    }
#endif
    return file_names(folder_of(folder.path(), kind)).size();
  }
  /// Changes the first byte of one.
  void damage(FileKind kind, const std::string& name) const {
#ifdef ANTICRACK_POSTGRESQL
    if (!url.empty()) {
      ask(url, fmt::format("UPDATE pieces SET body = set_byte(body, 0, get_byte(body, 0) # 255) "
                           "WHERE sha256 = '{}' AND n = 0",
                           name));
      return;
    }
#endif
    std::fstream(folder_of(folder.path(), kind) + "/" + name, std::ios::in | std::ios::out) << 'x';
  }
};

}  // namespace anticrack::store
