// SPDX-License-Identifier: GPL-3.0-or-later
//
// Results are on the disk while their jobs run, not in memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "jobs/engine_support.hpp"

namespace anticrack::jobs {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

/// "VmRSS": what is in memory; "VmHWM": the most since reset_peak().
std::uint64_t bytes_of_process(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == name + ":") {
      std::uint64_t kibibytes = 0;
      status >> kibibytes;
      return kibibytes << 10U;
    }
  }
  ADD_FAILURE() << "no " << name << " in /proc/self/status";
  return 0;
}

void reset_peak() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// Solves the job; returns its result's bytes over the growth of the process meanwhile.
double result_over_memory(Engine& test, const store::JobSpec& spec) {
  test.ended(test.submit(spec));  // what the first job needs stays
  reset_peak();
  const std::uint64_t before = bytes_of_process("VmRSS");
  const store::JobRecord record = test.ended(test.submit(spec));
  EXPECT_EQ(record.state, store::JobState::succeeded);
  EXPECT_GT(record.result_bytes, std::uint64_t{60} << 20U);
  const std::uint64_t peak = bytes_of_process("VmHWM");
  return static_cast<double>(record.result_bytes) /
         static_cast<double>(std::max<std::uint64_t>(peak - std::min(peak, before), 1));
}

TEST(EngineMemory, DoesNotGrowWithTheResultOfAJob) {
  if (sanitized) GTEST_SKIP() << "a sanitizer's allocator keeps what is freed";
  Engine test(one_thread());
  store::JobSpec spec;
  spec.mesh = test.ready_mesh(0.02);
  spec.fields = true;
  spec.solver = contact::ActiveSetOptions{};
  for (int i = 0; i < 1'500; ++i) spec.loads.push_back({std::to_string(i), double(i % 7), ""});
  EXPECT_GT(result_over_memory(test, spec), 3);
}

}  // namespace
}  // namespace anticrack::jobs
