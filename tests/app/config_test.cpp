// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "app/config_file.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

using ::testing::HasSubstr;

std::string problem_with(const std::string& toml) {
  try {
    make_config(parse_config(toml, "c.toml"), {});
    return "accepted";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(Config, RefusesAKeyOfManyParts) {
  std::string key = "listen";
  for (int i = 0; i < 200'000; ++i) {
    key += ".a";
  }
  EXPECT_EQ(problem_with("threads = 2\n" + key + " = 1\n"),
            "c.toml:2: a key of more than 32 parts; shorten it: known keys have at most 1");
}

TEST(Config, TakesEveryKeyOfAFile) {
  const Config config = make_config(parse_config(R"(
listen = "127.0.0.1:0"
data-dir = "/d"
memory-budget = "2GiB"
threads = 5
log-level = "warn"
drain-time = 0.5
mesher = "/m"
meshing-time = 60
upload-limit = 1000000
watchers = 7
allow-insecure-remote = true
log-format = "json"
metrics-listen = "127.0.0.1:9464"
drain-delay = "5s"
result-ttl = "7d"
queue-time = "12h"
run-time = "5m"
upload-ttl = 90
result-budget = "1GiB"
disk-budget = "20G"
result-limit = "64MiB"
queued-cases = 11
job-memory = "20MiB"
columns = 13
kept-meshes = 14
streams-a-client = 15
connections = 18
connections-an-address = 19
max-sweep-rows = 16
max-sweep-basis = 17
)",
                                                 "c.toml"),
                                    {});
  EXPECT_EQ(config.listen, "127.0.0.1:0");
  EXPECT_EQ(config.store.folder, "/d");
  EXPECT_EQ(config.limits.memory_budget_bytes, 2ull << 30);
  EXPECT_EQ(config.jobs.threads, 5);
  EXPECT_EQ(config.log_level, "warn");
  EXPECT_EQ(config.drain_time.count(), 500);
  EXPECT_EQ(config.meshes.helper.executable, "/m");
  EXPECT_EQ(config.meshing_time.count(), 60'000);
  EXPECT_EQ(config.limits.upload_bytes, 1'000'000u);
  EXPECT_EQ(config.limits.watchers, 7);
  EXPECT_TRUE(config.allow_insecure_remote);
  EXPECT_EQ(config.log_format, "json");
  EXPECT_EQ(config.metrics_listen, "127.0.0.1:9464");
  EXPECT_EQ(config.drain_delay, std::chrono::seconds(5));
  EXPECT_EQ(config.jobs.result_ttl, std::chrono::hours(7 * 24));
  EXPECT_EQ(config.jobs.queue_time, std::chrono::hours(12));
  EXPECT_EQ(config.jobs.run_time, std::chrono::minutes(5));
  EXPECT_EQ(config.jobs.upload_ttl, std::chrono::seconds(90));
  EXPECT_EQ(config.jobs.result_budget, 1ull << 30);
  EXPECT_EQ(config.store.disk_budget, 20'000'000'000u);
  EXPECT_EQ(config.jobs.max_result_bytes, 64ull << 20);
  EXPECT_EQ(config.jobs.max_queued_cases, 11);
  EXPECT_EQ(config.jobs.max_job_memory, 20ull << 20);
  EXPECT_EQ(config.jobs.columns, 13);
  EXPECT_EQ(config.jobs.max_sweep_rows, 16u);
  EXPECT_EQ(config.jobs.max_sweep_basis, 17);
  EXPECT_EQ(config.meshes.max_meshes, 14);
  EXPECT_EQ(config.limits.streams_a_client, 15);
  EXPECT_EQ(config.limits.connections, 18);
  EXPECT_EQ(config.limits.connections_an_address, 19);
}

TEST(Config, LetsTheCommandLineWin) {
  const Config config = make_config(parse_config("threads = 5\nwatchers = 7\n", "c.toml"),
                                    {{"threads", "6", "--threads"}});
  EXPECT_EQ(config.jobs.threads, 6);
  EXPECT_EQ(config.limits.watchers, 7);
}

TEST(Config, FindsOutWhatIsLeftOpen) {
  const Config config = make_config({}, {});
  EXPECT_GT(config.jobs.threads, 0);
  EXPECT_GT(config.limits.memory_budget_bytes, 0u);
  EXPECT_FALSE(config.store.folder.empty());
}

TEST(Config, NamesFileLineAndTheNearestKey) {
  const std::string problem = problem_with("threads = 2\n\nmemory-buget = 1\n");
  EXPECT_THAT(problem, HasSubstr("c.toml:3: unknown key \"memory-buget\""));
  EXPECT_THAT(problem, HasSubstr("memory-budget?"));
}

TEST(Config, NamesFileLineAndKeyOfABadValue) {
  EXPECT_THAT(problem_with("\nthreads = 0\n"),
              HasSubstr("c.toml:2: threads: \"0\" is not an integer"));
  EXPECT_THAT(problem_with("listen = \"here\""), HasSubstr("c.toml:1: listen: \"here\""));
  EXPECT_THAT(problem_with("log-level = \"inof\""), HasSubstr("did you mean info?"));
  EXPECT_THAT(problem_with("memory-budget = \"1KiB\""), HasSubstr("at least 1MiB"));
  EXPECT_THAT(problem_with("log-format = \"jsn\""), HasSubstr("did you mean json?"));
  EXPECT_THAT(problem_with("run-time = 0"), HasSubstr("at least 1"));
  EXPECT_THAT(problem_with("result-ttl = \"31d\""), HasSubstr("at most 30 days"));
  EXPECT_THAT(problem_with("metrics-listen = \"unix:/m\""), HasSubstr("not HOST:PORT"));
}

TEST(Config, RefusesOtherTypesOfValues) {
  EXPECT_THAT(problem_with("listen = 5"), HasSubstr("c.toml:1: listen takes a text"));
  EXPECT_THAT(problem_with("allow-insecure-remote = \"true\""), HasSubstr("true or false"));
  EXPECT_THAT(problem_with("threads = [1]"), HasSubstr("threads takes a number"));
  EXPECT_THAT(problem_with("[threads]"), HasSubstr("threads takes a number"));
}

TEST(Config, NamesTheLineWhereTheFileIsNoToml) {
  EXPECT_THAT(problem_with("threads = 1\nlisten =\n"), HasSubstr("c.toml:2: "));
  EXPECT_THAT(problem_with("threads = 1\nthreads = 2\n"), HasSubstr("c.toml:2: "));
}

TEST(Config, SaysWhichFileItCannotRead) {
  const anticrack::testing::TemporaryFolder folder;
  EXPECT_THROW(read_config_file(folder / "none.toml"), ConfigError);
  EXPECT_THROW(read_config_file(folder.path()), ConfigError);
}

TEST(Config, ListensBeyondTheMachineWithTlsOrWhenTold) {
  const std::string remote = "listen = \"0.0.0.0:7433\"\n";
  EXPECT_THAT(problem_with(remote), HasSubstr("--allow-insecure-remote"));
  EXPECT_THAT(problem_with(remote + "tokens = \"t\""), HasSubstr("nothing would be encrypted"));
  EXPECT_EQ(problem_with(remote + "allow-insecure-remote = true"), "accepted");
  EXPECT_EQ(problem_with(remote + "tls-certificate = \"c\"\ntls-key = \"k\""), "accepted");
}

TEST(Config, RefusesHalfOfASecurity) {
  EXPECT_THAT(problem_with("tls-key = \"k\""), HasSubstr("belong together"));
  EXPECT_THAT(problem_with("tls-certificate = \"c\""), HasSubstr("belong together"));
  EXPECT_THAT(problem_with("tls-client-roots = \"r\""), HasSubstr("tls-certificate and tls-key"));
  EXPECT_THAT(problem_with("admins = \"ann\""), HasSubstr("tls-client-roots"));
  EXPECT_EQ(problem_with("tls-certificate = \"c\"\ntls-key = \"k\"\ntls-client-roots = \"r\"\n"
                         "admins = \"ann\""),
            "accepted");
}

TEST(Config, IsWrittenSoThatItIsReadBack) {
  Config config = make_config({}, {});
  config.listen = "127.0.0.1:1";
  config.store.folder = "/a \"quoted\" \\ folder,\r\n\x1f\x7f\t\xc3\xa9 too";
  config.drain_time = std::chrono::milliseconds(1250);
  config.limits.upload_bytes = 1'234'567;
  config.allow_insecure_remote = true;
  const std::string text = to_toml(config);
  const Config again = make_config(parse_config(text, "c.toml"), {});
  EXPECT_EQ(again.store.folder, config.store.folder);
  EXPECT_EQ(to_toml(again), text);
  for (const Key& key : keys()) {
    EXPECT_THAT(text, HasSubstr(key.name + " = "));
  }
}

}  // namespace
}  // namespace anticrack::app
