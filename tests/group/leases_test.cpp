// SPDX-License-Identifier: GPL-3.0-or-later
//
// Who is judged to be dead, by a clock that the test moves.
#include "group/leases.hpp"

#include <gtest/gtest.h>

namespace anticrack::group {
namespace {

using namespace std::chrono_literals;

/// Reads once a second for `seconds`; server 1 beats each time, server 2 never. How many of the
/// reads found a server silent.
int read(Leases& leases, Leases::Time& now, std::int64_t& beats, int seconds) {
  int found = 0;
  for (int second = 0; second < seconds; ++second, now += 1s)
    for (const Beat& silent : leases.silent({{1, ++beats}, {2, 7}}, now)) {
      EXPECT_EQ(silent.epoch, 2);
      EXPECT_EQ(silent.beats, 7);
      ++found;
    }
  return found;
}

TEST(Leases, EndAfterALeaseWithoutABeat) {
  Leases leases;
  Leases::Time now{1h};
  std::int64_t beats = 0;
  const int lease = static_cast<int>(Leases::lease / 1s);
  EXPECT_EQ(read(leases, now, beats, lease), 0);
  EXPECT_EQ(read(leases, now, beats, 2), 2);
}

TEST(Leases, BeginAnewAfterAPauseOfTheReader) {
  Leases leases;
  Leases::Time now{1h};
  std::int64_t beats = 0;
  const int lease = static_cast<int>(Leases::lease / 1s);
  read(leases, now, beats, lease);
  now += 1h;  // nobody beat in what it saw of this hour
  EXPECT_EQ(read(leases, now, beats, lease), 0);
  EXPECT_EQ(read(leases, now, beats, 1), 1);
}

}  // namespace
}  // namespace anticrack::group
