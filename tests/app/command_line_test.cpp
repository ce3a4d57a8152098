// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace anticrack::app {
namespace {

using ::testing::HasSubstr;

CommandLine parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "anticrackd");
  return parse_command_line(static_cast<int>(arguments.size()), arguments.data(), "1.2.3");
}

TEST(CommandLine, GivesSettingsWithTheirFlags) {
  const CommandLine line = parse({"--threads", "3", "--listen=unix:/a", "--allow-insecure-remote"});
  ASSERT_EQ(line.settings.size(), 3u);
  for (const Setting& setting : line.settings) EXPECT_EQ(setting.where, "--" + setting.key);
  const Config config = make_config({}, line.settings);
  EXPECT_EQ(config.jobs.threads, 3);
  EXPECT_EQ(config.listen, "unix:/a");
  EXPECT_TRUE(config.allow_insecure_remote);
  EXPECT_FALSE(line.check_config);
  EXPECT_FALSE(line.text);
}

TEST(CommandLine, KnowsEveryKeyAsAFlag) {
  const CommandLine help = parse({"--help"});
  ASSERT_TRUE(help.text);
  for (const Key& key : keys()) EXPECT_THAT(*help.text, HasSubstr("--" + key.name));
}

TEST(CommandLine, TellsTheVersion) { EXPECT_EQ(parse({"--version"}).text, "anticrackd 1.2.3\n"); }

TEST(CommandLine, TakesTheFileAndTheCheck) {
  const CommandLine line = parse({"--config", "c.toml", "--check-config"});
  EXPECT_EQ(line.config_file, "c.toml");
  EXPECT_TRUE(line.check_config);
}

TEST(CommandLine, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(parse({"--thread", "3"}), ConfigError);
  EXPECT_THROW(parse({"somewhere"}), ConfigError);
  EXPECT_THROW(parse({"--threads"}), ConfigError);
}

}  // namespace
}  // namespace anticrack::app
