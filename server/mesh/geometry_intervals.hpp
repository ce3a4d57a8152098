// SPDX-License-Identifier: GPL-3.0-or-later
//
// How many pieces a curve is cut into.
#pragma once

#include <span>
#include <vector>

namespace anticrack::mesh {

/// Shares `total` intervals among curves by their lengths: largest remainder, at least one each
/// (so the sum is max(total, number of curves)); ties go to the curve that comes first.
/// Lengths positive. O(k log k) in the curves for a total of their order.
std::vector<int> apportion(std::span<const double> lengths, int total);

}  // namespace anticrack::mesh
