// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>

namespace anticrack::contact {

/// Detects an iteration that oscillates without converging. Above theta* the map of Algorithm 2
/// need not contract: a mode with 1 - theta lambda < -1 grows, changing sign in every iteration,
/// until the projection bounds it, and the criterion stagnates. A convergent iteration approaches
/// from one side (no turns) or turns while the criterion falls. Criterion: in two successive
/// windows of 40 iterations mu turns in most of them and the smallest criterion falls by less than
/// one part in 1000 (a contraction of 0.99999 an iteration). Used for theta > theta* only; below,
/// Theorem 4 guarantees convergence.
class StagnationMonitor {
 public:
  static constexpr int window = 40;

  /// Records an iteration; true once it is clear that the iteration cannot converge.
  bool add(double criterion, bool turned) {
    ++_count;
    _turns += turned ? 1 : 0;
    _smallest = std::min(_smallest, criterion);
    if (_count < window) return false;
    const bool stagnant =
        _smallest > rounding && _smallest >= progress * _previous_smallest && 2 * _turns > window;
    _count = _turns = 0;
    _previous_smallest = _smallest;
    _smallest = std::numeric_limits<double>::infinity();
    _stagnant_windows = stagnant ? _stagnant_windows + 1 : 0;
    return _stagnant_windows >= 2;
  }

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
