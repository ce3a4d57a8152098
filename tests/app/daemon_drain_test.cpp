// SPDX-License-Identifier: GPL-3.0-or-later
//
// The real executable: how it ends, and what it says of itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <memory>
#include <sstream>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::app {
namespace {

using anticrack::testing::Process;
using anticrack::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class DaemonsEnd : public ::testing::Test {
 protected:
  std::unique_ptr<Process> start(std::vector<std::string> flags,
                                 const std::vector<std::string>& environment = {}) {
    flags.insert(flags.begin(), {ANTICRACKD, "--listen", "127.0.0.1:0"});
    flags.insert(flags.end(), {"--data-dir", _folder / "data"});
    return std::make_unique<Process>(flags, environment);
  }

  TemporaryFolder _folder;
};

TEST_F(DaemonsEnd, ComesAtOnceWithASecondSignal) {
  const auto daemon = start({"--drain-delay", "1d"});
  ASSERT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
  daemon->signal(SIGTERM);
  ASSERT_TRUE(daemon->wait_for_error("stopping")) << daemon->error();
  daemon->signal(SIGINT);
  EXPECT_EQ(daemon->wait(), 128 + SIGINT) << "not after a day";

  const auto next = start({});
  ASSERT_TRUE(next->wait_for_output("\n")) << next->error();
  next->signal(SIGTERM);
  EXPECT_EQ(next->wait(), 0) << next->error();
}

TEST_F(DaemonsEnd, DoesNotComeWithTheTerminals) {
  const auto daemon = start({});
  ASSERT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
  daemon->signal(SIGHUP);
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->error();
}

TEST_F(DaemonsEnd, IsLoggedAsJson) {
  const auto daemon = start({"--log-format", "json", "--metrics-listen", "127.0.0.1:0"});
  ASSERT_TRUE(daemon->wait_for_error("\"event\":\"started\"")) << daemon->error();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0);
  const std::string log = daemon->error();
  EXPECT_THAT(log, HasSubstr(R"("event":"metrics","url":"http://127.0.0.1:)"));
  EXPECT_THAT(log, HasSubstr(R"("event":"stopping","signal":15,"again":)"));
  EXPECT_THAT(log, HasSubstr(R"("event":"stopped"})"));
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_THAT(line, StartsWith("{\"time\":\""));
  }
}

TEST_F(DaemonsEnd, SaysInTheLogWhyItDidNotStart) {
  const auto daemon =
      start({"--log-format", "json", "--tls-certificate", "/none", "--tls-key", "/none"});
  EXPECT_EQ(daemon->wait(), 2);
  EXPECT_THAT(daemon->error(), HasSubstr("\"event\":\"refused to start\",\"message\":\"tls-cert"));
  EXPECT_EQ(daemon->output(), "");
}

TEST_F(DaemonsEnd, ServesMetricsWhereTheyAreAskedFor) {
  const auto first = start({"--metrics-listen", "127.0.0.1:0"});
  ASSERT_TRUE(first->wait_for_error("started")) << first->error();
  std::string url = first->error();
  url = url.substr(url.find("http://") + 7);
  url = url.substr(0, url.find('/'));
  Process second({ANTICRACKD, "--listen", "127.0.0.1:0", "--data-dir", _folder / "other",
                  "--metrics-listen", url});
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(second.error(), HasSubstr("cannot serve metrics on " + url));
}

TEST_F(DaemonsEnd, IsToldToSystemd) {
  // A socket nobody listens on: what systemd hears is tested in notify_test.cpp.
  const auto daemon =
      start({}, {"NOTIFY_SOCKET=" + (_folder / "none").string(), "WATCHDOG_USEC=2000"});
  ASSERT_TRUE(daemon->wait_for_output("\n")) << daemon->error();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << "the watchdog's pings disturb nothing";
  EXPECT_THAT(daemon->error(), Not(HasSubstr("refused")));
}

}  // namespace
}  // namespace anticrack::app
