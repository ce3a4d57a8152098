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
)",
                                                 "c.toml"),
                                    {});
  EXPECT_EQ(config.listen, "127.0.0.1:0");
  EXPECT_EQ(config.data_dir, "/d");
  EXPECT_EQ(config.memory_budget, 2ull << 30);
  EXPECT_EQ(config.threads, 5);
  EXPECT_EQ(config.log_level, "warn");
  EXPECT_EQ(config.drain_time.count(), 500);
  EXPECT_EQ(config.mesher, "/m");
  EXPECT_EQ(config.meshing_time.count(), 60'000);
  EXPECT_EQ(config.upload_limit, 1'000'000u);
  EXPECT_EQ(config.watchers, 7);
  EXPECT_TRUE(config.allow_insecure_remote);
}

TEST(Config, LetsTheCommandLineWin) {
  const Config config = make_config(parse_config("threads = 5\nwatchers = 7\n", "c.toml"),
                                    {{"threads", "6", "--threads"}});
  EXPECT_EQ(config.threads, 6);
  EXPECT_EQ(config.watchers, 7);
}

TEST(Config, FindsOutWhatIsLeftOpen) {
  const Config config = make_config({}, {});
  EXPECT_GT(config.threads, 0);
  EXPECT_GT(config.memory_budget, 0u);
  EXPECT_FALSE(config.data_dir.empty());
}

TEST(Config, NamesFileLineAndTheNearestKey) {
  const std::string problem = problem_with("threads = 2\n\nmemory-buget = 1\n");
  EXPECT_THAT(problem, HasSubstr("c.toml:3: unknown key \"memory-buget\""));
  EXPECT_THAT(problem, HasSubstr("\"memory-budget\""));
}

TEST(Config, NamesFileLineAndKeyOfABadValue) {
  EXPECT_THAT(problem_with("\nthreads = 0\n"), HasSubstr("c.toml:2: threads: \"0\" is no integer"));
  EXPECT_THAT(problem_with("listen = \"here\""), HasSubstr("c.toml:1: listen: \"here\""));
  EXPECT_THAT(problem_with("log-level = \"inof\""), HasSubstr("did you mean \"info\"?"));
  EXPECT_THAT(problem_with("memory-budget = \"1KiB\""), HasSubstr("at least 1MiB"));
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

TEST(Config, ListensBeyondTheMachineOnlyWhenTold) {
  EXPECT_THAT(problem_with("listen = \"0.0.0.0:7433\""), HasSubstr("--allow-insecure-remote"));
  EXPECT_EQ(problem_with("listen = \"0.0.0.0:7433\"\nallow-insecure-remote = true"), "accepted");
}

TEST(Config, IsWrittenSoThatItIsReadBack) {
  Config config = make_config({}, {});
  config.listen = "127.0.0.1:1";
  config.data_dir = "/a \"quoted\" \\ folder";
  config.drain_time = std::chrono::milliseconds(1250);
  config.upload_limit = 1'234'567;
  config.allow_insecure_remote = true;
  const std::string text = to_toml(config);
  EXPECT_EQ(to_toml(make_config(parse_config(text, "c.toml"), {})), text);
  for (const Key& key : keys()) {
    if (key.name != "mesher") {
      EXPECT_THAT(text, HasSubstr(key.name + " = "));
    }
  }
}

}  // namespace
}  // namespace anticrack::app
