// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/pool.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <latch>
#include <thread>

#include "support/database.hpp"
#include "support/errors.hpp"

namespace anticrack::postgres {
namespace {

using anticrack::testing::Database;
using anticrack::testing::throws;
using errors::Reason;

class DatabasePool : public ::testing::Test {
 protected:
  void SetUp() override {
    query(pool, "CREATE TABLE public.t (n bigint PRIMARY KEY, v bigint NOT NULL)");
    query(pool, "INSERT INTO public.t VALUES (1, 0), (2, 0)");
  }
  Settings settings(std::chrono::seconds patience) const {
    return {Address(database.address()), "test",  3, std::chrono::seconds(2),
            std::chrono::seconds(20),    patience};
  }
  std::int64_t sum() { return query(pool, "SELECT sum(v)::bigint FROM public.t").integer(0, 0); }

  Database database;
  Pool pool{settings(std::chrono::seconds(60))};
};

TEST_F(DatabasePool, HasNoMoreConnectionsThanItMay) {
  std::vector<std::jthread> threads;
  for (int i = 0; i < 12; ++i)
    threads.emplace_back([&] {
      for (int round = 0; round < 10; ++round)
        transact(pool, [](Transaction& t) { t.run("UPDATE public.t SET v = v + 1 WHERE n = 1"); });
    });
  threads.clear();
  EXPECT_EQ(sum(), 120);
  EXPECT_LE(query(pool, "SELECT count(*) FROM pg_stat_activity WHERE application_name = 'test'")
                .integer(0, 0),
            3);
}

TEST_F(DatabasePool, RollsBackWorkThatThrows) {
  EXPECT_TRUE(throws(
      [&] {
        transact(pool, [](Transaction& t) {
          t.run("UPDATE public.t SET v = 9");
          throw errors::Error(Reason::not_found, "x");
        });
      },
      Reason::not_found));
  EXPECT_EQ(sum(), 0);
}

/// Each locks a row and then wants the other's.
TEST_F(DatabasePool, RepeatsATransactionThatWasInADeadlock) {
  std::latch both(2);
  std::atomic<int> runs = 0;
  const auto work = [&](std::int64_t first) {
    bool again = false;
    transact(pool, [&](Transaction& t) {
      ++runs;
      t.run("UPDATE public.t SET v = v + 1 WHERE n = $1", {first});
      if (!again) both.arrive_and_wait();
      again = true;
      t.run("UPDATE public.t SET v = v + 1 WHERE n = $1", {3 - first});
    });
  };
  {
    const std::jthread other([&] { work(2); });
    work(1);
  }
  EXPECT_EQ(sum(), 4);
  EXPECT_EQ(runs, 3);
}

TEST_F(DatabasePool, WaitsForADatabaseThatComesBack) {
  int runs = 0;
  transact(pool, [&](Transaction& t) {
    t.run("UPDATE public.t SET v = v + 1 WHERE n = 1");
    if (++runs == 1) {
      database.stop();
      database.start();
    }
    t.run("UPDATE public.t SET v = v + 1 WHERE n = 2");
  });
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(sum(), 2);
  EXPECT_EQ(pool.unreachable().count(), 0);
}

TEST_F(DatabasePool, SaysSinceWhenTheDatabaseIsGone) {
  Pool hasty(settings(std::chrono::seconds(0)));
  query(hasty, "SELECT 1");
  EXPECT_EQ(hasty.unreachable().count(), 0);
  database.stop();
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE(throws([&] { query(hasty, "SELECT 1"); }, Reason::storage));
  EXPECT_GT(hasty.unreachable().count(), 0);
  database.start();
  query(pool, "SELECT 1");
  query(hasty, "SELECT 1");
  EXPECT_EQ(hasty.unreachable().count(), 0);
}

TEST_F(DatabasePool, RefusesToCommitWhatHasFailed) {
  EXPECT_TRUE(throws(
      [&] {
        transact(pool, [](Transaction& t) {
          t.run("UPDATE public.t SET v = 9");
          try {
            t.run("SELECT 1 / 0");
          } catch (const Failure&) {
          }
        });
      },
      Reason::internal));
  EXPECT_EQ(sum(), 0);
}

}  // namespace
}  // namespace anticrack::postgres
