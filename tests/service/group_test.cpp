// SPDX-License-Identifier: GPL-3.0-or-later
//
// Three servers on one PostgreSQL: any of them answers for any job, and the death of one loses
// none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include "client/jobs.hpp"
#include "service/group_fixture.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"
#include "support/random_seed.hpp"

namespace anticrack::service_test {
namespace {

using anticrack::testing::eventually;
using namespace std::chrono_literals;

/// The result of a server on its own.
client::Block alone(const Work& work) {
  const Daemon daemon({"--threads", "1"});
  client::Connection connection(daemon.connection());
  const v1::Job job = submit(connection, work, client::make_uuid());
  wait_for_end(connection, job.name());
  return client::read_result(connection, job.name());
}

bool iterates(client::Connection& connection, const std::string& name, int attempt) {
  return eventually([&] {
    const v1::JobStatus status = client::get_job(connection, name).status();
    return status.state() == v1::JobStatus::STATE_RUNNING && status.attempt() == attempt;
  });
}

TEST_F(Group, AnswersForAnyJobAtAnyServer) {
  client::Connection a(add().connection()), b(add().connection()), c(add().connection());
  const v1::Job job = submit(a, work("paper-3.toml", iterations(1'000'000)), client::make_uuid());
  std::vector<std::thread> watchers;
  std::array<std::atomic<int>, 3> samples{};
  std::array<v1::Job, 3> ends;
  std::array<std::uint64_t, 3> last{};
  std::array<client::Connection*, 3> all{&a, &b, &c};
  for (std::size_t i = 0; i < all.size(); ++i)
    watchers.emplace_back([&, i] {
      ends[i] = client::watch_job(*all[i], job.name(), 0, [&](const v1::WatchJobResponse& event) {
        EXPECT_GE(event.sequence(), last[i]);
        last[i] = event.sequence();
        if (event.has_samples()) ++samples[i];
      });
    });
  for (const auto& count : samples) EXPECT_TRUE(eventually([&] { return count > 2; }));
  for (client::Connection* one : all) {
    EXPECT_TRUE(iterates(*one, job.name(), 1));
    EXPECT_EQ(client::list_jobs(*one, {}).jobs_size(), 1);
  }
  // Two of these do not run it.
  for (client::Connection* one : all) client::cancel_job(*one, job.name());
  for (std::thread& watcher : watchers) watcher.join();
  EXPECT_EQ(ends[0].status().state(), v1::JobStatus::STATE_CANCELLED);
  EXPECT_EQ(ends[0].SerializeAsString(), ends[1].SerializeAsString());
  EXPECT_EQ(ends[0].SerializeAsString(), ends[2].SerializeAsString());
  EXPECT_EQ(last[0], last[1]) << "events have the same numbers everywhere";
  EXPECT_EQ(last[0], last[2]);
  client::delete_job(c, job.name());
  EXPECT_EQ(client::list_jobs(a, {}).jobs_size(), 0);

  const Work quick = work("slit.toml");
  const client::Block expected = alone(quick);
  const std::string request = client::make_uuid();
  const std::string name = submit(a, quick, request).name();
  for (client::Connection* one : all) {
    EXPECT_EQ(submit(*one, quick, request).name(), name);
    EXPECT_TRUE(ran_to_its_end(wait_for_end(*one, name)));
    EXPECT_EQ(difference(client::read_result(*one, name), expected), "");
  }
}

TEST_F(Group, TakesOverWhatADeadServerRanWhileWatchersWatch) {
  Daemon& first = add();
  v1::Job job;
  {
    client::Connection a(first.connection());
    job = submit(a, work("paper-3.toml", iterations(1'000'000)), client::make_uuid());
    ASSERT_TRUE(iterates(a, job.name(), 1));
  }
  Daemon& second = add();
  client::Connection b(second.connection());
  std::uint64_t last = 0;
  std::atomic<bool> of_first = false, of_second = false;
  v1::Job end;
  std::thread watcher([&] {
    client::Connection connection(second.connection());
    end = client::watch_job(connection, job.name(), 0, [&](const v1::WatchJobResponse& event) {
      EXPECT_GE(event.sequence(), last) << "nothing comes again";
      last = event.sequence();
      if (event.has_samples()) (last < numbers_of_an_attempt ? of_first : of_second) = true;
    });
  });
  EXPECT_TRUE(eventually([&] { return of_first.load(); }));
  first.kill();  // and nobody starts it again
  EXPECT_TRUE(eventually([&] { return of_second.load(); }));
  EXPECT_TRUE(iterates(b, job.name(), 2));
  client::cancel_job(b, job.name());
  watcher.join();
  EXPECT_EQ(end.status().attempt(), 2);
  EXPECT_EQ(end.status().state(), v1::JobStatus::STATE_CANCELLED);
}

TEST_F(Group, APausedServerDoesNoHarm) {
  const Work long_work = work("paper-3.toml", iterations(100'000));
  Daemon& first = add();
  client::Connection a(first.connection());
  const v1::Job job = submit(a, long_work, client::make_uuid());
  ASSERT_TRUE(iterates(a, job.name(), 1));
  first.process().signal(SIGSTOP);
  client::Connection b(add().connection());
  EXPECT_TRUE(iterates(b, job.name(), 2));
  first.process().signal(SIGCONT);
  const v1::Job end = wait_for_end(a, job.name());
  EXPECT_EQ(end.status().attempt(), 2);
  EXPECT_TRUE(ran_to_its_end(end));
  EXPECT_EQ(difference(client::read_result(a, job.name()), alone(long_work)), "");
  servers[1]->kill();  // so the first one, which is a new epoch, has to run this
  const v1::Job next = submit(a, work("slit.toml"), client::make_uuid());
  EXPECT_TRUE(ran_to_its_end(wait_for_end(a, next.name())));
}

TEST_F(Group, ACancelAtAServerThatHasLostTheJobReachesTheOneThatHasIt) {
  Daemon& first = add();
  client::Connection a(first.connection());
  const v1::Job job = submit(a, work("paper-3.toml", iterations(1'000'000)), client::make_uuid());
  ASSERT_TRUE(iterates(a, job.name(), 1));
  first.process().signal(SIGSTOP);
  client::Connection b(add().connection());
  ASSERT_TRUE(iterates(b, job.name(), 2));
  first.process().signal(SIGCONT);
  client::cancel_job(a, job.name());
  const v1::Job end = wait_for_end(b, job.name());
  EXPECT_EQ(end.status().attempt(), 2);
  EXPECT_EQ(end.status().state(), v1::JobStatus::STATE_CANCELLED);
}

TEST_F(Group, ADrainedServerGivesItsJobsBackAtOnce) {
  Daemon& first = add({"--drain-time", "0"});
  client::Connection a(first.connection());
  std::vector<std::string> names;
  for (int i = 0; i < 3; ++i)
    names.push_back(
        submit(a, work("paper-3.toml", iterations(50'000)), client::make_uuid()).name());
  ASSERT_TRUE(iterates(a, names[0], 1));
  client::Connection b(add().connection());
  EXPECT_EQ(first.stop(), 0);
  EXPECT_EQ(count("queue WHERE runner NOT IN (SELECT epoch FROM anticrack.servers)"), 0U);
  for (const std::string& name : names) EXPECT_TRUE(ran_to_its_end(wait_for_end(b, name)));
}

/// What was acknowledged is at the standby, where the group goes on by itself.
TEST_F(Group, GoesOnAtAStandbyThatIsPromoted) {
  const anticrack::testing::Database standby(&database);
  url = database.address_or(standby);
  const Work quick = work("slit.toml"), long_work = work("paper-3.toml", iterations(100'000));
  client::Connection a(add().connection()), b(add().connection());
  const std::string ended = submit(a, quick, client::make_uuid()).name();
  EXPECT_TRUE(ran_to_its_end(wait_for_end(a, ended)));
  const std::string running = submit(a, long_work, client::make_uuid()).name();
  EXPECT_TRUE(iterates(b, running, 1));
  database.stop();  // and nobody starts it again
  standby.promote();
  const std::string next = submit(b, quick, client::make_uuid()).name();
  for (const std::string& name : {ended, next}) {
    EXPECT_TRUE(ran_to_its_end(wait_for_end(b, name)));
    EXPECT_EQ(difference(client::read_result(b, name), alone(quick)), "");
  }
  EXPECT_TRUE(ran_to_its_end(wait_for_end(a, running)));
  EXPECT_EQ(difference(client::read_result(a, running), alone(long_work)), "");
  servers.clear();  // before their database
}

/// A job that a server has acknowledged.
struct Acknowledged {
  std::string name, request;
  std::size_t work = 0;
};

/// A long run: ANTICRACK_KILLS=200 test_service --gtest_filter=Group.Each* --gtest_random_seed=7
TEST_F(Group, EachAcknowledgedJobEndsOnceUnderKills) {
  const char* const given = std::getenv("ANTICRACK_KILLS");
  const int kills = given == nullptr ? 30 : std::stoi(given);
  constexpr int kills_between_crashes = 12;  ///< of the database
  const std::vector<Work> works{work("slit.toml"), work("paper.toml", iterations(200)),
                                work("paper-3.toml", iterations(20'000))};
  for (int i = 0; i < 3; ++i) add({"--log-level", "error"});
  std::atomic<bool> done = false;
  std::mutex mutex;
  std::vector<Acknowledged> jobs;
  std::vector<std::thread> clients;
  for (std::size_t i = 0; i < servers.size(); ++i)
    clients.emplace_back([&, i] {
      client::Connection connection(servers[i]->connection());
      std::minstd_rand random(static_cast<unsigned>(i + 1));
      while (!done) {
        Acknowledged one{{}, client::make_uuid(), random() % works.size()};
        one.name = submit(connection, works[one.work], one.request).name();
        {
          const std::lock_guard lock(mutex);
          jobs.push_back(one);
        }
        if (random() % 3 == 0) wait_for_end(connection, one.name);
      }
    });
  std::minstd_rand random(anticrack::testing::random_seed());
  const auto heard = [&] {
    const std::lock_guard lock(mutex);
    return jobs.size();
  };
  for (int kill = 0; kill < kills; ++kill) {
    const std::size_t before = heard();
    eventually([&] { return heard() > before; });
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 400));
    if (kill % kills_between_crashes == kills_between_crashes / 2) {
      database.stop();
      database.start();
    }
    Daemon& victim = *servers[random() % servers.size()];
    victim.kill();
    victim.start();
  }
  done = true;
  for (std::thread& client : clients) client.join();

  client::Connection connection(servers[0]->connection());
  std::vector<client::Block> expected;
  for (const Work& one : works) expected.push_back(alone(one));
  std::set<std::string> names;
  for (const Acknowledged& one : jobs) {
    EXPECT_TRUE(names.insert(one.name).second) << "two requests, one job";
    const v1::Job end = wait_for_end(connection, one.name);
    EXPECT_TRUE(ran_to_its_end(end)) << end.ShortDebugString();
    EXPECT_EQ(difference(client::read_result(connection, one.name), expected[one.work]), "")
        << works[one.work].name;
    EXPECT_EQ(submit(connection, works[one.work], one.request).name(), one.name);
  }
  EXPECT_EQ(count("jobs"), jobs.size());
  EXPECT_EQ(count("queue"), 0U);
}

}  // namespace
}  // namespace anticrack::service_test
