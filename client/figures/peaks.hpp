// SPDX-License-Identifier: GPL-3.0-or-later
//
// The end of an axis for values that are singular at the tips.
#pragma once

#include <utility>
#include <vector>

namespace anticrack::figures {

struct Peaks {
  double highest = 0;  ///< of all values
  double shown = 0;    ///< end of the axis

  bool cut_off() const noexcept { return shown < highest; }
};

/// Of values that are not negative and their weights: the axis ends at `room` times what `part` of
/// the weight stays below; at the highest if that is little more. Zeros of no value. O(n log n).
Peaks peaks(std::vector<std::pair<double, double>> weighted, double part, double room);

}  // namespace anticrack::figures
