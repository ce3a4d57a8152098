// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far a sweep has come, folded from its events. Pure: the time is told.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {

/// Rows that were seen. O(log k) an interval, k of them apart from each other.
class RowSet {
 public:
  using Interval = std::pair<std::uint64_t, std::uint64_t>;  ///< end excluded
  /// What of [begin, end) is new.
  std::vector<Interval> add(std::uint64_t begin, std::uint64_t end);

 private:
  std::map<std::uint64_t, std::uint64_t> _ends;  // begin -> end, disjoint
};

class SweepProgress {
 public:
  std::uint64_t total = 0;  ///< rows; 0: not known yet

  /// Rows: that ended, of these without an answer for want of steps, and with an error.
  std::uint64_t done() const noexcept { return _counts.done; }
  std::uint64_t not_converged() const noexcept { return _counts.not_converged; }
  std::uint64_t failed() const noexcept { return _counts.failed; }
  /// Rows a second over the last few seconds; NaN before there is anything to measure.
  double rate() const noexcept;
  double seconds_left() const noexcept;  ///< NaN where it cannot be told

  /// Rows may come again, after a watch that began anew. `seconds`: when they came, on any clock
  /// that does not go back.
  void apply(const v1::SweepRows& rows, double seconds);
  /// What the server counted. Never less than what was seen.
  void apply(const v1::SweepAnswer& answer);
  /// The server runs the sweep anew.
  void restart();

 private:
  struct Counts {
    std::uint64_t done = 0;
    std::uint64_t not_converged = 0;
    std::uint64_t failed = 0;
  };
  struct Sample {
    double seconds = 0;
    std::uint64_t done = 0;
  };
  void count(const v1::SweepRows& rows, const RowSet::Interval& interval);
  void raise(const Counts& counts);

  RowSet _rows;
  Counts _seen;    // by rows
  Counts _counts;  // by rows or by the server, whoever knows more
  std::deque<Sample> _samples;
  double _now = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace anticrack::cli
