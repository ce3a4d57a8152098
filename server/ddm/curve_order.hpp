// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::ddm {

/// Puts nodes that are near each other next to each other: along a Z-order curve (G. Morton, 1966)
/// over their bounding box, 2^16 cells a side; within a cell they keep their order. What works on a
/// mesh numbered so finds neighbours in the cache. `xy`: (n,2) row-major. O(k).
void sort_along_curve(std::vector<std::int32_t>& nodes, std::span<const double> xy);

}  // namespace anticrack::ddm
