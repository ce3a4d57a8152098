// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a stop and a start of the server mean for jobs, clients and results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <numeric>
#include <thread>

#include "client/jobs.hpp"
#include "service/daemon.hpp"
#include "service/stored_data.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"
#include "support/flip.hpp"

namespace anticrack::service_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int long_run = 100'000;

std::vector<std::string> run_long(const std::string& output) {
  std::vector<std::string> arguments = {"run", example("paper-3.toml"), "-o", output};
  for (const std::string& override_text : iterations(long_run)) {
    arguments.insert(arguments.end(), {"--set", override_text});
  }
  return arguments;
}

/// Waits until the only job iterates.
std::string iterating_job(client::Connection& connection) {
  std::string name;
  EXPECT_TRUE(anticrack::testing::eventually([&] {
    const v1::ListJobsResponse response = client::list_jobs(connection, {});
    if (response.jobs_size() != 1 ||
        response.jobs(0).status().state() != v1::JobStatus::STATE_RUNNING) {
      return false;
    }
    name = response.jobs(0).name();
    return true;
  }));
  return name;
}

TEST(Restart, AClientsRunOutlivesAStopAndAKill) {
  Daemon daemon({"--drain-time", "0"});
  client::Connection connection(daemon.connection());
  const std::string output = (daemon.folder() / "out.h5").string();
  const auto run = start_client(daemon.address(), run_long(output));
  const std::string name = iterating_job(connection);

  EXPECT_EQ(daemon.stop(), 0);
  daemon.start();
  ASSERT_TRUE(anticrack::testing::eventually([&] {
    return client::get_job(connection, name).status().attempt() >= 2;
  })) << "what had not ended begins anew";
  daemon.kill();
  daemon.start();

  EXPECT_EQ(run->wait(std::chrono::seconds(300)), 3) << run->output() << run->error();
  EXPECT_THAT(run->output(), HasSubstr("trying again"));
  const v1::Job job = client::get_job(connection, name);
  EXPECT_EQ(job.status().answers(0).iterations(), long_run);
  EXPECT_EQ(run_client(daemon.address(), {"show", output}).code, 0);
  EXPECT_EQ(client::list_jobs(connection, {}).jobs_size(), 1) << "nothing was submitted twice";
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_THAT(flaws_of(daemon.data()), IsEmpty());
}

/// Numbers of rows of growth that a watcher heard of, a list for each attempt of the job.
using Heard = std::vector<std::vector<int>>;

TEST(Restart, GrowthThatIsKilledEndsWithTheSameRowsAndBounds) {
  Daemon daemon;
  client::Connection connection(daemon.connection());
  const Work growing = work("growth.toml", {"mesh.preset=uniform", "mesh.size=0.02",
                                            "geometry.boundary=[[-1,-1],[1,-1],[1,1],[-1,1]]",
                                            "growth.positions=20", "growth.final=6"});
  const v1::Job whole = wait_for_end(connection, submit(connection, growing, "whole").name());
  const auto& rows = whole.status().answers(0).growth();
  ASSERT_GT(rows.size(), 6) << whole.status().DebugString();
  std::vector<int> all(static_cast<std::size_t>(rows.size()));
  std::iota(all.begin(), all.end(), 0);
  for (int i = 0; i < rows.size(); ++i)
    if (rows[i].has_g1_final()) all.push_back(i);
  ASSERT_EQ(all.size(), static_cast<std::size_t>(rows.size()) + 6);

  const std::string name = submit(connection, growing, "killed").name();
  Heard heard;
  std::promise<void> in_the_middle;
  std::jthread watcher([&] {
    client::watch_job(connection, name, 0, [&](const v1::WatchJobResponse& event) {
      if (!event.has_growth_step()) return;
      const v1::GrowthStep& step = event.growth_step();
      if (step.number() == 0 && !step.row().has_g1_final()) heard.emplace_back();
      heard.back().push_back(step.number());
      if (heard.size() == 1 && step.row().has_g1_final() && step.number() == 0)
        in_the_middle.set_value();
    });
  });
  ASSERT_EQ(in_the_middle.get_future().wait_for(std::chrono::minutes(5)),
            std::future_status::ready);
  daemon.kill();
  daemon.start();
  watcher.join();
  const v1::Job job = wait_for_end(connection, name);
  EXPECT_EQ(job.status().attempt(), 2);
  EXPECT_EQ(job.status().state(), v1::JobStatus::STATE_SUCCEEDED);
  ASSERT_EQ(job.status().answers(0).growth_size(), rows.size());
  for (int i = 0; i < rows.size(); ++i)
    EXPECT_EQ(job.status().answers(0).growth(i).SerializeAsString(), rows[i].SerializeAsString());
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_LT(heard[0].size(), all.size());
  EXPECT_TRUE(std::equal(heard[0].begin(), heard[0].end(), all.begin())) << "no hole, no repeat";
  EXPECT_EQ(heard[1], all);
}

TEST(Restart, ARetryGivesTheSameJobThoughLimitsHaveChanged) {
  Daemon first;
  std::vector<std::pair<Work, std::string>> asked;  // by default as many iterations, and explicitly
  for (const std::vector<std::string>& changes :
       {std::vector<std::string>{}, std::vector<std::string>{"solver.max_iterations=2000"}}) {
    asked.emplace_back(work("paper-3.toml", changes), client::make_uuid());
  }
  std::vector<std::string> names;
  client::Connection connection(first.connection());
  for (const auto& [job, id] : asked) names.push_back(submit(connection, job, id).name());
  EXPECT_EQ(first.stop(), 0);
  Daemon limited(first.data(), {"--iterations", "500"});
  client::Connection again(limited.connection());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(submit(again, asked[i].first, asked[i].second).name(), names[i]);
  }
  EXPECT_THROW(submit(again, asked[1].first, client::make_uuid()), client::Error);
}

TEST(Restart, ASecondSigtermDoesNotWaitForJobs) {
  Daemon daemon({"--drain-time", "3600"});
  client::Connection connection(daemon.connection());
  Work endless = work("paper-3.toml", {"solver.theta=1e-7", "solver.epsilon=1e-300",
                                       "solver.max_iterations=1000000"});
  submit(connection, endless, client::make_uuid());
  const std::string name = iterating_job(connection);
  daemon.process().signal(SIGTERM);
  ASSERT_TRUE(daemon.process().wait_for_error("stopping"));
  daemon.stop();  // throws where it goes on
  daemon.start();
  EXPECT_TRUE(anticrack::testing::eventually([&] {
    return client::get_job(connection, name).status().state() == v1::JobStatus::STATE_RUNNING;
  })) << "the next start takes it up";
  client::cancel_job(connection, name);
  EXPECT_EQ(wait_for_end(connection, name).status().state(), v1::JobStatus::STATE_CANCELLED);
}

TEST(Restart, AStopRightAfterALargeAnswerIsNotHeldUp) {
  // As --local stops its server. The answer is larger than what the socket takes at once, which
  // used to keep gRPC, and with it the server, for ten seconds, in about every second stop.
  constexpr std::chrono::seconds hang_limit{6};
  for (int stop = 1; stop <= 5; ++stop) {
    Daemon daemon;
    const Ended run =
        daemon.client({"run", example("paper.toml"), "-o", daemon.folder() / "out.h5"});
    ASSERT_EQ(run.code, 0) << run.output << run.error;
    daemon.process().signal(SIGTERM);
    ASSERT_EQ(daemon.process().wait(hang_limit), 0)
        << "stop " << stop << " of 5: " << daemon.process().error();
  }
}

TEST(Restart, ExpiredResultsSaySoAndGiveTheCure) {
  Daemon daemon({"--result-ttl", "1"});
  client::Connection connection(daemon.connection());
  const Work quick = work("slit.toml", {"mesh.preset=uniform", "mesh.size=0.2"});
  const std::string name = submit(connection, quick, client::make_uuid()).name();
  wait_for_end(connection, name);
  ASSERT_TRUE(anticrack::testing::eventually(
      [&] { return client::get_job(connection, name).status().has_expire_time(); }));
  const v1::Job job = client::get_job(connection, name);
  EXPECT_EQ(job.status().state(), v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_EQ(job.status().result_state(), v1::JobStatus::RESULT_STATE_EXPIRED);
  const Ended fetch = daemon.client({"job", "fetch", name, "-o", daemon.folder() / "late.h5"});
  EXPECT_EQ(fetch.code, 2);
  EXPECT_THAT(fetch.error, HasSubstr("run the case again"));
  EXPECT_THAT(daemon.client({"job", "show", name}).output, HasSubstr("were removed"));
}

TEST(Restart, OneFolderHasOneServer) {
  Daemon daemon;
  EXPECT_THROW(Daemon(daemon.data(), {}), std::runtime_error);
  client::Connection connection(daemon.connection());
  EXPECT_NO_THROW(client::server_info(connection)) << "the first one goes on";
}

TEST(Restart, RefusesAFolderThatLostItsDatabaseAndRemovesNothing) {
  Daemon daemon;
  client::Connection connection(daemon.connection());
  const Work quick = work("slit.toml", {"mesh.preset=uniform", "mesh.size=0.2"});
  const std::string name = submit(connection, quick, client::make_uuid()).name();
  EXPECT_EQ(wait_for_end(connection, name).status().state(), v1::JobStatus::STATE_SUCCEEDED);
  const client::Block result = client::read_result(connection, name);
  EXPECT_EQ(daemon.stop(), 0);

  const std::filesystem::path database = daemon.data() + "/anticrack.db";
  const std::filesystem::path backup = daemon.folder() / "backup.db";
  std::filesystem::rename(database, backup);
  daemon.launch();
  EXPECT_EQ(daemon.process().wait(), 1);
  EXPECT_THAT(daemon.process().error(),
              AllOf(HasSubstr(daemon.data() + " has the files of a store (meshes: 1, "),
                    HasSubstr("from a backup")));
  daemon.kill();
  std::filesystem::rename(backup, database);
  daemon.start();
  EXPECT_EQ(difference(client::read_result(connection, name), result), "");
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_THAT(flaws_of(daemon.data()), IsEmpty());
}

TEST(Restart, ServesAroundADamagedRecordAndSetsItAside) {
  Daemon daemon;
  client::Connection connection(daemon.connection());
  Work quick = work("slit.toml", {"mesh.preset=uniform", "mesh.size=0.2"});
  const std::string sound = submit(connection, quick, client::make_uuid()).name();
  quick.spec.set_title("a title to be found");
  const std::string damaged = submit(connection, quick, client::make_uuid()).name();
  wait_for_end(connection, sound);
  wait_for_end(connection, damaged);
  const client::Block result = client::read_result(connection, sound);
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_EQ(daemon.run_on_data({"--check-store"}).code, 0);

  const std::string database = daemon.data() + "/anticrack.db";
  const auto places = anticrack::testing::places_of(quick.spec.title(), database);
  ASSERT_FALSE(places.empty());
  for (const std::size_t place : places) anticrack::testing::flip(database, place, 20);
  daemon.start();
  const v1::Job job = client::get_job(connection, damaged);
  EXPECT_EQ(job.status().state(), v1::JobStatus::STATE_FAILED);
  EXPECT_THAT(job.status().error().message(), AllOf(HasSubstr(damaged), HasSubstr("damaged")));
  EXPECT_EQ(job.status().answers_size(), 0);
  EXPECT_THROW(client::read_result(connection, damaged), client::Error);
  EXPECT_EQ(client::list_jobs(connection, {}).jobs_size(), 2);
  EXPECT_EQ(difference(client::read_result(connection, sound), result), "");
  EXPECT_EQ(daemon.run_on_data({"--check-store"}).code, 2) << "a server uses it";
  EXPECT_EQ(daemon.stop(), 0);

  const Ended found = daemon.run_on_data({"--check-store"});
  EXPECT_EQ(found.code, 3) << found.error;
  EXPECT_THAT(found.output, AllOf(HasSubstr(damaged), HasSubstr("--repair")));
  const Ended repaired = daemon.run_on_data({"--check-store", "--repair"});
  EXPECT_EQ(repaired.code, 0) << repaired.error;
  EXPECT_THAT(repaired.output, HasSubstr("set-aside-1"));
  daemon.start();
  EXPECT_EQ(client::list_jobs(connection, {}).jobs_size(), 1);
  EXPECT_EQ(difference(client::read_result(connection, sound), result), "");
  EXPECT_EQ(daemon.stop(), 0);
  EXPECT_THAT(flaws_of(daemon.data()), IsEmpty());
}

}  // namespace
}  // namespace anticrack::service_test
