// SPDX-License-Identifier: GPL-3.0-or-later
//
// Help and exit codes. What is said of wrong command lines: bad_usage_test.py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::internal::CaptureStderr;
using ::testing::internal::CaptureStdout;
using ::testing::internal::GetCapturedStderr;
using ::testing::internal::GetCapturedStdout;

struct Ran {
  int code;
  std::string output, error;
};

Ran run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "anticrack");
  std::vector<char*> argv;
  argv.reserve(arguments.size());
  for (std::string& argument : arguments) {
    argv.push_back(argument.data());
  }
  CaptureStdout();
  CaptureStderr();
  const int code = run_command_line(static_cast<int>(argv.size()), argv.data());
  const std::string output = GetCapturedStdout();
  return {code, output, GetCapturedStderr()};
}

TEST(CommandLine, HelpOfEveryCommandHasAnExample) {
  const std::vector<std::vector<std::string>> commands{{},
                                                       {"run"},
                                                       {"sweep"},
                                                       {"mesh", "create"},
                                                       {"mesh", "upload"},
                                                       {"mesh", "list"},
                                                       {"mesh", "show"},
                                                       {"mesh", "warm"},
                                                       {"mesh", "evict"},
                                                       {"mesh", "delete"},
                                                       {"job", "submit"},
                                                       {"job", "list"},
                                                       {"job", "show"},
                                                       {"job", "watch"},
                                                       {"job", "cancel"},
                                                       {"job", "fetch"},
                                                       {"job", "delete"},
                                                       {"show"},
                                                       {"plot"},
                                                       {"export"},
                                                       {"server"}};
  for (std::vector<std::string> command : commands) {
    command.emplace_back("--help");
    const Ran help = run(command);
    EXPECT_EQ(help.code, exit_ok) << command.front();
    EXPECT_THAT(help.output, HasSubstr("Example:\n  anticrack"));
  }
  EXPECT_THAT(run({"--help"}).output, HasSubstr("Exit codes:"));
}

TEST(CommandLine, TellsItsVersion) {
  EXPECT_THAT(run({"--version"}).output, ::testing::StartsWith("anticrack "));
  EXPECT_EQ(run({"-v"}).output, run({"--version"}).output);
}

TEST(ExitCodes, SeparateBadInputFromABadServer) {
  using client::Code;
  for (const Code code : {Code::invalid_argument, Code::not_found, Code::unimplemented,
                          Code::failed_precondition, Code::out_of_range}) {
    EXPECT_EQ(exit_code_of(code), exit_usage) << name(code);
  }
  for (const Code code : {Code::unavailable, Code::resource_exhausted, Code::deadline_exceeded,
                          Code::permission_denied, Code::internal, Code::unknown}) {
    EXPECT_EQ(exit_code_of(code), exit_server) << name(code);
  }
}

}  // namespace
}  // namespace anticrack::cli
