// SPDX-License-Identifier: GPL-3.0-or-later
//
// Results are on the disk while their jobs run, not in memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "jobs/engine_support.hpp"
#include "support/process_memory.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::memory_of;

/// Solves the job; returns its result's bytes over the growth of the process meanwhile.
double result_over_memory(Engine& test, const records::JobSpec& spec) {
  test.ended(test.submit(spec));  // what the first job needs stays
  EXPECT_TRUE(anticrack::testing::reset_peak_memory());
  const std::uint64_t before = memory_of("VmRSS");
  const records::JobRecord record = test.ended(test.submit(spec));
  EXPECT_EQ(record.state, records::JobState::succeeded);
  EXPECT_GT(record.result_bytes, std::uint64_t{60} << 20U);
  const std::uint64_t peak = memory_of("VmHWM");
  EXPECT_GT(before, 0U);
  EXPECT_GT(peak, 0U);
  return static_cast<double>(record.result_bytes) /
         static_cast<double>(std::max<std::uint64_t>(peak - std::min(peak, before), 1));
}

TEST(EngineMemory, DoesNotGrowWithTheResultOfAJob) {
  if (anticrack::testing::sanitized) GTEST_SKIP() << "a sanitizer's allocator keeps what is freed";
  Engine test(one_thread());
  records::JobSpec spec;
  spec.mesh = test.ready_mesh(0.02);
  spec.fields = true;
  spec.solver = contact::ActiveSetOptions{};
  for (int i = 0; i < 1'500; ++i) spec.loads.push_back({std::to_string(i), double(i % 7), ""});
  // Below 1 if the result were there. What else grows is the allocator's share of each thread, and
  // of spare ones where the machine is busy.
  EXPECT_GT(result_over_memory(test, spec), 1.5);
}

}  // namespace
}  // namespace anticrack::jobs
