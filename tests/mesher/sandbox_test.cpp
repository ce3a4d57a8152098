// SPDX-License-Identifier: GPL-3.0-or-later
//
// The helper at work, seen from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "mesher/real_helper.hpp"
#include "mesher/sanitized.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

/// The value of a line "KEY: VALUE" of /proc/PID/status; empty when the process is gone.
std::string status(const fs::path& process, const std::string& key) {
  std::ifstream lines(process / "status");
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key + ":")) continue;
    const std::size_t value = line.find_first_not_of(" \t", key.size() + 1);
    return value == std::string::npos ? std::string() : line.substr(value);
  }
  return {};
}

/// The helper this process started; empty while there is none.
fs::path helper_process() {
  const std::string own = std::to_string(getpid());
  for (const auto& entry : fs::directory_iterator("/proc")) {
    int number = 0;
    const std::string name = entry.path().filename();
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc{} || *end != '\0') continue;
    // the name is cut at 15 letters; before the exec it is this program's
    if (status(entry.path(), "PPid") == own && status(entry.path(), "Name") == "anticrack-meshe") {
      return entry.path();
    }
  }
  return {};
}

/// A long request under way in another thread, stopped in the end.
class Working {
 public:
  Working()
      : _thread([this](const std::stop_token& stop) {
          constexpr std::size_t enough = 20'000'000;
          const auto plan =
              mesh::plan(testing::paper_geometry(), {mesh::Preset::uniform, 0.001}, enough);
          _error = testing::error_of([&] {
            mesher::run(testing::real_helper(), mesh::GenerateRequest{plan, enough}, stop);
          });
        }) {}

  std::optional<errors::Error> stop() {
    _thread.request_stop();
    _thread.join();
    return _error;
  }

 private:
  std::optional<errors::Error> _error;
  std::jthread _thread;
};

TEST(Sandbox, IsInForceWhileTheHelperWorks) {
  if (mesher::sanitized) GTEST_SKIP() << "the filter is left out";
  Working working;
  fs::path process;
  ASSERT_TRUE(testing::eventually([&] {
    process = helper_process();
    return !process.empty();
  }));
  EXPECT_TRUE(testing::eventually([&] { return status(process, "Seccomp") == "2"; }));
  EXPECT_EQ(status(process, "NoNewPrivs"), "1");
  EXPECT_EQ(status(process, "Threads"), "1");
  std::set<std::string> descriptors;
  for (const auto& entry : fs::directory_iterator(process / "fd")) {
    descriptors.insert(entry.path().filename());
  }
  EXPECT_THAT(descriptors, ElementsAre("0", "1", "2"));
  const auto error = working.stop();
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), errors::Reason::cancelled) << error->what();
}

}  // namespace
}  // namespace anticrack
