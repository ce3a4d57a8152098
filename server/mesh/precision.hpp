// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far from the origin a membrane may lie. All geometry is reckoned from differences of
// coordinates, so that what counts is only how the coordinates themselves were rounded.
#pragma once

#include <limits>

namespace anticrack::mesh {

/// A membrane that is less across than this part of its largest coordinate is refused.
inline constexpr double least_extent = 1e-8;

/// Places nearer than this part of the largest coordinate may be one place, rounded.
inline constexpr double coordinate_rounding = 4 * std::numeric_limits<double>::epsilon();

}  // namespace anticrack::mesh
