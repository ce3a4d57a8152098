// SPDX-License-Identifier: GPL-3.0-or-later
//
// The progress of a sweep, folded from its events. Pure: times are arguments.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {

class SweepProgress {
 public:
  std::uint64_t total = 0;  ///< rows; 0: not known yet

  /// The number of rows that have ended; of these, how many did not converge, and how many failed.
  std::uint64_t done() const noexcept { return _counts.done; }
  std::uint64_t not_converged() const noexcept { return _counts.not_converged; }
  std::uint64_t failed() const noexcept { return _counts.failed; }
  /// Rows per second over the last few seconds; NaN: unknown.
  double rate() const noexcept;
  double seconds_left() const noexcept;  ///< NaN: unknown

  /// Adds rows; a new watch may repeat them. `seconds`: when they arrived, on any monotonic clock.
  void apply(const v1::SweepRows& rows, double seconds);
  /// Takes the server's counts, which are used if they are larger than those of the rows seen.
  void apply(const v1::SweepAnswer& answer);
  /// To be called when the server runs the sweep again.
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
  void raise(const Counts& counts);

  std::vector<bool> _ended;  // rows seen; a bit each
  Counts _seen;              // counted from rows
  Counts _counts;            // the larger of rows' and server's
  std::deque<Sample> _samples;
  double _now = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace anticrack::cli
