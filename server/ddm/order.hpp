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

/// The conditions on cycles a >= b >= ... >= a, whose values are all equal. O(k^2).
std::vector<Above> on_cycles(const std::vector<Above>& conditions);

/// Transitive reduction: each pair once, none of a value with itself, none that follows from
/// others. Unique without cycles; sorted. O(k^2).
std::vector<Above> without_implied(std::vector<Above> conditions);

}  // namespace anticrack::ddm
