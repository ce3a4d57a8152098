// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which servers have stopped to beat. Clocks of two machines are never compared.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <vector>

namespace anticrack::group {

/// A server, and how often it has beaten.
struct Beat {
  std::int64_t epoch = 0;
  std::int64_t beats = 0;
};

/// Judges by the clock of this process over reads without a gap: whoever was paused, or could not
/// read for a while, has not seen that others did not beat. Not thread-safe.
class Leases {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds lease{6}, longest_gap{3};

  /// Takes what was read at `now`; returns those that have not beaten for a lease. O(n log n).
  std::vector<Beat> silent(const std::vector<Beat>& read, Time now);

 private:
  struct Seen {
    std::int64_t beats = 0;
    Time since{};
  };
  std::map<std::int64_t, Seen> _seen;
  Time _last{};
};

}  // namespace anticrack::group
