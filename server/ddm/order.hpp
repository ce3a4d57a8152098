// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small systems of conditions w[upper] >= w[lower] between the values of one node.
#pragma once

#include <cstdint>
#include <vector>

namespace anticrack::ddm {

struct Above {
  std::int32_t upper = 0;
  std::int32_t lower = 0;
  auto operator<=>(const Above&) const = default;
};

/// Those on a closed way round: a >= b >= ... >= a, so that all its values are equal. O(k^2).
std::vector<Above> on_cycles(const std::vector<Above>& conditions);

/// Each couple once, none of a value with itself, and none that follows from the others (a >= c
/// from a >= b and b >= c). Without cycles the result is unique; sorted. O(k^2).
std::vector<Above> without_implied(std::vector<Above> conditions);

}  // namespace anticrack::ddm
