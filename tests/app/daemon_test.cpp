// SPDX-License-Identifier: GPL-3.0-or-later
//
// The real executable as a process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

using anticrack::testing::Process;
using anticrack::testing::TemporaryFolder;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class Daemon : public ::testing::Test {
 protected:
  std::unique_ptr<Process> start(std::vector<std::string> flags) {
    flags.insert(flags.begin(), ANTICRACKD);
    flags.insert(flags.end(), {"--data-dir", _folder / "data"});
    return std::make_unique<Process>(flags);
  }

  TemporaryFolder _folder;
};

TEST_F(Daemon, SaysOneLineWhenItIsReadyAndStopsOnSigterm) {
  for (const int number : {SIGTERM, SIGINT}) {
    const bool by_name = number == SIGINT;  // which a machine need not know
    const auto daemon = start({"--listen", by_name ? "localhost:0" : "127.0.0.1:0"});
    ASSERT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
    daemon->signal(number);
    EXPECT_EQ(daemon->wait(), 0) << daemon->error();
    EXPECT_THAT(daemon->output(), MatchesRegex("anticrackd listening on 127.0.0.1:[1-9][0-9]+\n"));
  }
}

TEST_F(Daemon, KeepsItsDataToItself) {
  const auto daemon = start({"--listen", "127.0.0.1:0"});
  ASSERT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
  struct stat found {};
  ASSERT_EQ(::stat((_folder / "data").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0700u);

  const auto second = start({"--listen", "127.0.0.1:0"});
  EXPECT_EQ(second->wait(), 2);
  EXPECT_THAT(second->error(), HasSubstr("another anticrackd uses it"));
}

TEST_F(Daemon, ServesOnAUnixSocketAndTakesItAway) {
  const std::string path = _folder / "socket";
  {
    const auto killed = start({"--listen", "unix:" + path});
    ASSERT_TRUE(killed->wait_for_output("listening on unix:" + path + "\n")) << killed->error();
    killed->signal(SIGKILL);
    EXPECT_EQ(killed->wait(), 128 + SIGKILL);
  }
  EXPECT_TRUE(std::filesystem::exists(path));
  const auto daemon = start({"--listen", "unix:" + path});
  ASSERT_TRUE(daemon->wait_for_output("listening on unix:" + path + "\n")) << daemon->error();
  struct stat found {};
  ASSERT_EQ(::stat(path.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0077, 0u);
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(Daemon, SaysThatAnAddressIsTaken) {
  const auto first = start({"--listen", "127.0.0.1:0"});
  ASSERT_TRUE(first->wait_for_output("\n")) << first->error();
  std::string address = first->output();
  address = address.substr(address.rfind(' ') + 1);
  address.pop_back();
  Process second({ANTICRACKD, "--listen", address, "--data-dir", _folder / "other"});
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(second.error(), HasSubstr("cannot listen on " + address));
  EXPECT_EQ(second.output(), "");
}

TEST_F(Daemon, ChecksItsConfiguration) {
  std::ofstream(_folder / "c.toml") << "threads = 3\nmemory-budget = \"1GiB\"\n";
  const auto daemon = start({"--config", _folder / "c.toml", "--threads", "4", "--check-config"});
  EXPECT_EQ(daemon->wait(), 0);
  EXPECT_THAT(daemon->output(), HasSubstr("threads = 4\n"));
  EXPECT_THAT(daemon->output(), HasSubstr("memory-budget = \"1GiB\"\n"));
  EXPECT_FALSE(std::filesystem::exists(_folder / "data"));
}

TEST_F(Daemon, ChecksTheFilesOfItsConfigurationAndNamesEachBadOne) {
  std::ofstream(_folder / "tokens") << "ann king 00\n";
  std::ofstream(_folder / "file") << "x";
  const auto path = [this](const char* name) { return std::string(_folder / name); };
  Process check({ANTICRACKD, "--check-config", "--tls-certificate", path("none.crt"), "--tls-key",
                 path("none.key"), "--tls-client-roots", path("file"), "--tokens", path("tokens"),
                 "--data-dir", path("file") + "/data", "--mesher", path("none")});
  EXPECT_EQ(check.wait(), 2);
  for (const std::string& flaw :
       {"tls-certificate: " + path("none.crt") + " cannot be read",
        "tls-key: " + path("none.key") + " cannot be read",
        std::string("tls-client-roots: no certificate in it"),
        "tokens: " + path("tokens") + ", line 1",
        "data-dir: " + path("file") + "/data: ", std::string("--mesher PATH")}) {
    EXPECT_THAT(check.error(), HasSubstr(flaw));
  }
}

TEST_F(Daemon, RefusesABadConfigurationInOneLine) {
  std::ofstream(_folder / "c.toml") << "\nthread = 3\n";
  const auto daemon = start({"--config", _folder / "c.toml"});
  EXPECT_EQ(daemon->wait(), 2);
  EXPECT_EQ(daemon->output(), "");
  EXPECT_THAT(daemon->error(), HasSubstr("c.toml:2: unknown key \"thread\""));
  EXPECT_THAT(daemon->error(), EndsWith("did you mean threads?\n"));
}

TEST_F(Daemon, RefusesToListenBeyondTheMachine) {
  const auto daemon = start({"--listen", "0.0.0.0:0"});
  EXPECT_EQ(daemon->wait(), 2);
  EXPECT_THAT(daemon->error(), HasSubstr("--allow-insecure-remote"));
}

TEST_F(Daemon, RefusesAMesherThatIsNotThere) {
  const auto daemon = start({"--listen", "127.0.0.1:0", "--mesher", _folder / "none"});
  EXPECT_EQ(daemon->wait(), 2);
  EXPECT_THAT(daemon->error(), HasSubstr("--mesher PATH"));
}

TEST_F(Daemon, ChecksItsStoreAndSetsAsideWhatHasNoDatabase) {
  EXPECT_EQ(start({"--check-store"})->wait(), 2) << "there is no folder";
  EXPECT_FALSE(std::filesystem::exists(_folder / "data"));
  std::filesystem::create_directories(_folder / "data/results");
  EXPECT_EQ(start({"--check-store"})->wait(), 0) << "there is nothing in it";
  const std::string name = "results/" + std::string(64, 'a');
  std::ofstream(_folder / ("data/" + name)) << "x";
  EXPECT_EQ(start({"--listen", "127.0.0.1:0"})->wait(), 1);
  const auto check = start({"--check-store"});
  EXPECT_EQ(check->wait(), 3);
  EXPECT_THAT(check->output(), HasSubstr(name + " belongs to no record\n"));
  EXPECT_TRUE(std::filesystem::exists(_folder / ("data/" + name)));
  EXPECT_EQ(start({"--repair"})->wait(), 2);
  EXPECT_EQ(start({"--check-store", "--repair"})->wait(), 0);
  EXPECT_TRUE(std::filesystem::exists(_folder / ("data/set-aside-1/" + name)));
  const auto daemon = start({"--listen", "127.0.0.1:0"});
  EXPECT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
}

}  // namespace
}  // namespace anticrack::app
