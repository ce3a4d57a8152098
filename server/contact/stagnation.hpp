// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace anticrack::contact {

/// Recognises an iteration that oscillates for ever. Above theta* the map of Algorithm 2 need not
/// contract: a mode with 1 - theta lambda < -1 grows, its sign turning in every iteration, until
/// the projection bounds it; the criterion then stays where it is. A convergent iteration either
/// approaches slowly from one side (no turns) or turns with a criterion that falls.
/// So: in a window of 40 iterations mu turned in most, and the smallest criterion is no smaller
/// than in the window before (by at least one part in 1000, a contraction of 0.99999 an iteration),
/// and this twice in a row. Only asked when theta > theta*: below it convergence is a theorem.
class StagnationMonitor {
 public:
  static constexpr int window = 40;

  /// Returns true once the iteration is recognised as one that cannot converge.
  bool add(double criterion, bool turned);

 private:
  static constexpr double progress = 0.999;
  static constexpr double rounding = 1e-20;  // below it a criterion is noise, not oscillation

  int _count = 0;
  int _turns = 0;
  int _stagnant_windows = 0;
  double _smallest = std::numeric_limits<double>::infinity();
  double _previous_smallest = std::numeric_limits<double>::infinity();
};

}  // namespace anticrack::contact
