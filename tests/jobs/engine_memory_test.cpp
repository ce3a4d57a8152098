// SPDX-License-Identifier: GPL-3.0-or-later
//
// Results are on the disk while their jobs run, not in memory.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <stop_token>
#include <string>
#include <thread>

#include "jobs/engine_support.hpp"
#include "support/process_memory.hpp"

namespace anticrack::jobs {
namespace {

/// Bytes that the process has allocated. Resident memory says less: it counts what glibc keeps of
/// what was freed, which is more where long-lived pieces lie between the vectors of load cases.
std::uint64_t allocated() {
  const struct mallinfo2 now = mallinfo2();
  return now.uordblks + now.hblkhd;
}

struct Use {
  std::uint64_t result;  ///< bytes
  std::uint64_t most;    ///< bytes allocated at once while the job ran
};

Use solve(Engine& test, records::JobSpec spec, int loads) {
  for (int i = 0; i < loads; ++i) spec.loads.push_back({std::to_string(i), double(i % 7), ""});
  std::uint64_t most = 0;
  std::jthread meter([&most](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      most = std::max(most, allocated());
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  const records::JobRecord record = test.ended(test.submit(spec));
  meter.request_stop();
  meter.join();
  EXPECT_EQ(record.state, records::JobState::succeeded);
  return {record.result_bytes, most};
}

TEST(EngineMemory, DoesNotGrowWithTheResultOfAJob) {
  if (anticrack::testing::sanitized) GTEST_SKIP() << "a sanitizer's allocator keeps what is freed";
  Engine test(one_thread());
  records::JobSpec spec;
  spec.mesh = test.ready_mesh(0.02);
  spec.fields = true;
  spec.solver = contact::ActiveSetOptions{};
  const Use small = solve(test, spec, 100);
  const Use large = solve(test, spec, 1'000);
  const std::uint64_t more = large.result - small.result;
  EXPECT_GT(more, std::uint64_t{60} << 20U);
  EXPECT_GT(small.most, 0U);
  RecordProperty("more_allocated", std::to_string(large.most - small.most));
  EXPECT_LT(3 * (large.most - std::min(small.most, large.most)), more);
}

}  // namespace
}  // namespace anticrack::jobs
