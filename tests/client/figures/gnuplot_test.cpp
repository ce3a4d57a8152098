// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "figures/figures.hpp"
#include "support/sample_result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::TemporaryFolder;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

std::string failure(const std::string& script, const std::string& folder,
                    std::chrono::milliseconds limit = 120s) {
  try {
    run_gnuplot(script, folder, limit);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Gnuplot, runs_in_the_folder) {
  const TemporaryFolder folder;
  run_gnuplot("set print 'a.txt'\nprint 2+3\n", folder.path(), 120s);
  EXPECT_TRUE(std::filesystem::exists(folder / "a.txt"));
}

TEST(Gnuplot, that_fails_says_why) {
  const TemporaryFolder folder;
  const std::string what = failure("plot $missing\n", folder.path());
  EXPECT_THAT(what, HasSubstr("exit code"));
  EXPECT_THAT(what, HasSubstr("missing"));
}

TEST(Gnuplot, that_stops_reading_is_an_error_and_no_signal) {
  const TemporaryFolder folder;
  std::string script = "exit status 7\n";
  script.append(4'000'000, '#');
  EXPECT_THAT(failure(script, folder.path()), HasSubstr("exit code 7"));
}

TEST(Gnuplot, takes_a_script_larger_than_a_pipe) {
  const TemporaryFolder folder;
  std::string script = "$data << EOD\n";
  for (int i = 0; i < 300'000; ++i) script += "1 2 3 4\n";
  EXPECT_EQ(failure(script + "EOD\n", folder.path()), "no error");
}

TEST(Gnuplot, that_prints_much_does_not_block) {
  const TemporaryFolder folder;
  EXPECT_EQ(failure("do for [i=1:50000] { print 'a line on standard error' }\n", folder.path()),
            "no error");
}

TEST(Gnuplot, that_takes_too_long_is_stopped) {
  const TemporaryFolder folder;
  EXPECT_THAT(failure("while (1) { a = 1 }\n", folder.path(), 300ms), HasSubstr("longer than"));
}

TEST(Gnuplot, that_is_killed_by_others_names_the_signal) {
  const TemporaryFolder folder;
  EXPECT_THAT(failure("result = system('kill -SEGV $PPID')\n", folder.path()),
              HasSubstr("signal 11"));
  EXPECT_THAT(failure("result = system('kill -KILL $PPID')\n", folder.path()),
              HasSubstr("signal 9"));
}

TEST(Gnuplot, in_a_missing_folder_is_an_error) {
  const TemporaryFolder folder;
  EXPECT_THAT(failure("print 1\n", folder / "missing"), HasSubstr("No such file or directory"));
}

/// Another PATH until the end of the scope.
class Path {
 public:
  explicit Path(const std::string& value) : _before(std::getenv("PATH")) {
    setenv("PATH", value.c_str(), 1);
  }
  ~Path() { setenv("PATH", _before.c_str(), 1); }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

 private:
  std::string _before;
};

TEST(Gnuplot, that_is_not_installed_is_named_with_its_package) {
  const TemporaryFolder folder;
  const Path path(folder.path());
  EXPECT_THAT(failure("print 1\n", folder.path()), HasSubstr("gnuplot-nox"));
  EXPECT_THROW(draw(anticrack::testing::sample_result(4), folder / "figures"), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "figures"));
}

}  // namespace
}  // namespace anticrack::figures
