// SPDX-License-Identifier: GPL-3.0-or-later
#include "log/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <cstdint>
#include <functional>
#include <limits>

namespace anticrack::log {
namespace {

using ::testing::EndsWith;
using ::testing::MatchesRegex;

std::string written(const std::string& level, Format format, const std::function<void()>& action) {
  ::testing::internal::CaptureStderr();
  start(level, format);
  action();
  return ::testing::internal::GetCapturedStderr();
}

TEST(Log, WritesTextForPeople) {
  EXPECT_THAT(written("info", Format::text,
                      [] {
                        info("job ended", {{"job", "jobs/ab12"}, {"title", "a b"}});
                      }),
              MatchesRegex("20[0-9-]+T[0-9:]+\\.[0-9]+[+-][0-9]+:[0-9]+ info job ended "
                           "job=jobs/ab12 title=\"a b\"\n"));
}

TEST(Log, WritesJsonForMachines) {
  EXPECT_THAT(written("info", Format::json,
                      [] {
                        error("job ended", {{"job", "jobs/ab12"}, {"state", "FAILED"}});
                      }),
              MatchesRegex(R"(\{"time":"20[0-9T:.+-]+","level":"error","event":"job ended",)"
                           R"("job":"jobs/ab12","state":"FAILED"\})"
                           "\n"));
}

TEST(Log, WritesNumbersOfJsonWithoutQuotes) {
  const auto numbers = [] {
    info("job ended", {{"attempt", 1},
                       {"bytes", std::uint64_t{18446744073709551615U}},
                       {"seconds", 0.25},
                       {"lost", std::numeric_limits<double>::quiet_NaN()},
                       {"id", "42"}});
  };
  EXPECT_THAT(written("info", Format::json, numbers),
              EndsWith(R"("attempt":1,"bytes":18446744073709551615,"seconds":0.250,"lost":null,)"
                       R"("id":"42"})"
                       "\n"));
  EXPECT_THAT(written("info", Format::text, numbers),
              EndsWith("attempt=1 bytes=18446744073709551615 seconds=0.250 lost=null id=42\n"));
}

TEST(Log, LetsNoValueForgeALineOrAKey) {
  const auto attack = [] {
    info("mesh made", {{"title", "x\" state=\"READY\n2026 error all lost {0} %v"}});
  };
  EXPECT_THAT(written("info", Format::text, attack),
              EndsWith(R"(title="x\" state=\"READY\n2026 error all lost {0} %v")"
                       "\n"));
  EXPECT_THAT(written("info", Format::json, attack),
              EndsWith(R"("title":"x\" state=\"READY\n2026 error all lost {0} %v"})"
                       "\n"));
}

TEST(Log, TakesWhatLibrariesSayTheSameWay) {
  const auto library = [] { spdlog::error("broken \"{}\"", "a\nb"); };
  EXPECT_THAT(written("info", Format::json, library),
              MatchesRegex(R"(\{"time":"20[0-9T:.+-]+","level":"error",)"
                           R"("event":"broken \\"a\\nb\\""\})"
                           "\n"));
  EXPECT_THAT(written("info", Format::text, library), EndsWith(R"( error broken \"a\nb\")"
                                                               "\n"));
  EXPECT_EQ(written("off", Format::text, library), "");
}

TEST(Log, WritesNothingBelowItsLevel) {
  const auto all = [] {
    info("a");
    warn("b");
    error("c");
  };
  EXPECT_THAT(written("warn", Format::text, all),
              MatchesRegex("[^\n]* warning b\n[^\n]* error c\n"));
  EXPECT_EQ(written("off", Format::json, all), "");
}

}  // namespace
}  // namespace anticrack::log
