// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::ddm {

/// Sorts nodes along a Z-order curve (G. Morton, 1966) over their bounding box, 2^16 cells a side,
/// stable within a cell, so that nearby nodes share cache lines. `xy`: (n,2) row-major. O(k).
void sort_along_curve(std::vector<std::int32_t>& nodes, std::span<const double> xy);

}  // namespace anticrack::ddm
