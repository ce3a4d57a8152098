// SPDX-License-Identifier: GPL-3.0-or-later
//
// Loading and evicting leaves no memory behind. A program of its own: what other tests leave in
// the heap would be in the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "operators/cache_support.hpp"
#include "support/process_memory.hpp"

namespace anticrack::operators {
namespace {

/// Bytes of this process that are in memory.
std::uint64_t resident_bytes() {
  const std::uint64_t bytes = anticrack::testing::memory_of("VmRSS");
  EXPECT_GT(bytes, 0U) << "no VmRSS in /proc/self/status";
  return bytes;
}

TEST(ResidentMemory, IsWithinFivePercentAfterFiftyLoadsAndEvictions) {
  if (anticrack::testing::sanitized) {
    GTEST_SKIP() << "a sanitizer's allocator keeps what is freed";
  }
  constexpr int warm_up = 5;
  constexpr int cycles = 50;
  const auto mesh = small_mesh(330);  // 108,900 triangles
  OperatorCache cache(std::uint64_t{4} << 30, [](auto cut, std::stop_token stop) {
    return MeshOperator::factorise(std::move(cut), 2, stop);
  });
  std::uint64_t operators = 0;
  std::uint64_t loaded = 0;
  const auto cycle = [&] {
    operators = cache.acquire("mesh", mesh, {})->bytes();
    loaded = resident_bytes();
    ASSERT_EQ(cache.evict("mesh"), OperatorCache::Eviction::done);
  };
  for (int i = 0; i < warm_up; ++i) {
    cycle();
  }
  const std::uint64_t start = resident_bytes();
  for (int i = 0; i < cycles; ++i) {
    cycle();
  }
  const std::uint64_t end = resident_bytes();
  // What was loaded was seen to come, so its going would be seen to fail.
  EXPECT_GT(operators, start / 5);
  EXPECT_GT(loaded, start + operators / 2);
  // Five per cent of the process with its mesh. Arenas and stacks of threads, which differ from run
  // to run, are a few per cent of it; a hundredth of what is evicted, kept each time, would be a
  // third.
  EXPECT_LE(end, start + loaded / 20)
      << "at the start " << start << " bytes, in the end " << end << ", loaded " << loaded;
  RecordProperty("start_bytes", std::to_string(start));
  RecordProperty("end_bytes", std::to_string(end));
  RecordProperty("loaded_bytes", std::to_string(loaded));
}

}  // namespace
}  // namespace anticrack::operators
