// SPDX-License-Identifier: GPL-3.0-or-later
//
// Clients that go away, servers that stop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "service/processes.hpp"

namespace anticrack::service_test {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> run_endless(const std::string& output) {
  std::vector<std::string> arguments = {"run", example("paper-3.toml"), "-o", output};
  for (const std::string& word : endless()) arguments.push_back(word);
  return arguments;
}

TEST(Interruption, DetachAndAttachAgainInMidIteration) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const auto run = server.start_client(run_endless(folder / "out.h5"));
  const std::string name = server.running_job();

  run->signal(SIGINT);
  ASSERT_TRUE(run->wait().has_value());
  EXPECT_THAT(run->output() + run->error(), HasSubstr("anticrack job watch " + name))
      << "detaching names the command that attaches again";
  EXPECT_EQ(server.job(name).status().state(), v1::JobStatus::STATE_RUNNING)
      << "detaching cancels nothing";

  const auto watch = server.start_client({"job", "watch", name});
  ASSERT_TRUE(watch->wait_for_output("iteration") || watch->wait_for_error("iteration"))
      << watch->output() << watch->error();
  EXPECT_EQ(server.client({"job", "cancel", name}).code, 0);
  EXPECT_TRUE(watch->wait().has_value()) << "the watch ends with the job";
  EXPECT_EQ(server.ended_job(name).status().state(), v1::JobStatus::STATE_CANCELLED);
}

TEST(Interruption, AClientKilledWhileStreamingHurtsNobody) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const auto victim = server.start_client(run_endless(folder / "victim.h5"));
  const std::string name = server.running_job();
  victim->signal(SIGKILL);
  ASSERT_TRUE(victim->wait().has_value());

  const Ended other = server.client({"run", example("paper-1.toml"), "-o", folder / "other.h5"});
  EXPECT_EQ(other.code, 0) << other.error;
  EXPECT_EQ(server.job(name).status().state(), v1::JobStatus::STATE_RUNNING);
  EXPECT_EQ(server.client({"job", "cancel", name}).code, 0);
  EXPECT_EQ(server.ended_job(name).status().state(), v1::JobStatus::STATE_CANCELLED);
}

TEST(Interruption, SigtermWithStreamsOpenStopsInTime) {
  Server server;
  const anticrack::testing::TemporaryFolder folder;
  const auto run = server.start_client(run_endless(folder / "out.h5"));
  const std::string name = server.running_job();
  const auto first = server.start_client({"job", "watch", name});
  const auto second = server.start_client({"job", "watch", name});
  ASSERT_TRUE(first->wait_for_output("iteration") || first->wait_for_error("iteration"));

  server.process().signal(SIGTERM);
  // The limit is the promise, not a measurement: "stops in under 5 s".
  const auto code = server.process().wait(std::chrono::seconds(5));
  ASSERT_TRUE(code.has_value()) << "still there after 5 s";
  EXPECT_EQ(*code, 0) << server.process().error();
  for (const auto* client : {run.get(), first.get(), second.get()}) client->signal(SIGKILL);
}

}  // namespace
}  // namespace anticrack::service_test
