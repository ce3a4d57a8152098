// SPDX-License-Identifier: GPL-3.0-or-later
//
// The command line as far as it needs no server.
#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/commands.hpp"
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

TEST(CommandLine, SuggestsTheCommandThatWasMeant) {
  const Ran typo = run({"rnu", "case.toml"});
  EXPECT_EQ(typo.code, exit_usage);
  EXPECT_THAT(typo.error, HasSubstr("unknown command rnu; did you mean run?"));
  for (const char* flag : {"--server", "--ca", "--token-file", "--retry-for"}) {
    EXPECT_THAT(run({flag, "1", "--json", "job", "wacth"}).error,
                HasSubstr("unknown command wacth; did you mean watch?"));
  }
}

TEST(CommandLine, RefusesWrongUsage) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"run"},
                                             {"mesh"},
                                             {"show", "a", "b"},
                                             {"run", "a", "--sett", "x=1"},
                                             {"server", "--retry-for", "soon"},
                                             {"plot", "a.h5", "-o", "b", "--dpi", "0"},
                                             {"job", "list", "--limit", "0"}}) {
    const Ran wrong = run(arguments);
    EXPECT_EQ(wrong.code, exit_usage);
    EXPECT_FALSE(wrong.error.empty());
    EXPECT_TRUE(wrong.output.empty());
  }
}

TEST(CommandLine, NamesACaseThatCannotBeRead) {
  const Ran missing = run({"run", "no-such-case.toml"});
  EXPECT_EQ(missing.code, exit_usage);
  EXPECT_THAT(missing.error, HasSubstr("no-such-case.toml"));
}

TEST(CommandLine, NamesAResultThatCannotBeRead) {
  for (const char* command : {"show", "plot", "export"}) {
    std::vector<std::string> arguments{command, "no-such-file.h5"};
    if (std::string(command) != "show") {
      arguments.insert(arguments.end(), {"-o", "figures"});
    }
    const Ran missing = run(arguments);
    EXPECT_EQ(missing.code, exit_usage);
    EXPECT_THAT(missing.error, HasSubstr("no-such-file.h5"));
  }
}

TEST(CommandLine, SaysWhichFormatsOfFiguresThereAre) {
  for (const char* list : {"gif", "png,,svg", ""}) {
    const Ran wrong = run({"plot", "a.h5", "-o", "figures", "--format", list});
    EXPECT_EQ(wrong.code, exit_usage) << list;
    EXPECT_THAT(wrong.error, HasSubstr("is none of png, svg and pdf")) << list;
  }
  // The list does not take what follows.
  EXPECT_THAT(run({"plot", "-o", "figures", "--format", "pdf,png", "no-such-file.h5"}).error,
              HasSubstr("no-such-file.h5"));
}

TEST(CommandLine, ReportsErrorsAsOneJsonDocument) {
  const Ran missing = run({"--json", "run", "no-such-case.toml"});
  EXPECT_EQ(missing.code, exit_usage);
  google::protobuf::Struct document;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(missing.output, &document).ok())
      << missing.output;
  const auto& error = document.fields().at("error").struct_value().fields();
  EXPECT_EQ(error.at("code").string_value(), "CASE");
  EXPECT_THAT(error.at("message").string_value(), HasSubstr("no-such-case.toml"));
}

TEST(CommandLine, NamesTheCredentialThatCannotBeUsed) {
  const Ran missing = run({"server", "--ca", "no-such-file.pem"});
  EXPECT_EQ(missing.code, exit_usage);
  EXPECT_THAT(missing.error, HasSubstr("--ca: no-such-file.pem"));
  const Ran open =
      run({"server", "--server", "far.example:7433", "--token-file", EXAMPLES "/arc.toml"});
  EXPECT_EQ(open.code, exit_usage);
  EXPECT_THAT(open.error, HasSubstr("arc.toml is not a token"));
}

TEST(CommandLine, AnUnreachableServerIsItsOwnExitCode) {
  const Ran unreachable = run({"--server", "unix:/nonexistent/socket", "server"});
  EXPECT_EQ(unreachable.code, exit_server);
  EXPECT_THAT(unreachable.error, HasSubstr("/nonexistent/socket"));
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
