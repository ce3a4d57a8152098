// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far from the origin a membrane may lie. All geometry is computed from differences of
// coordinates, so only the rounding of the coordinates themselves matters.
#pragma once

#include <limits>

namespace anticrack::mesh {

/// A membrane whose extent is below this fraction of its largest coordinate is refused.
inline constexpr double least_extent = 1e-8;

/// Points nearer than this fraction of the largest coordinate may be one point, but for rounding.
inline constexpr double coordinate_rounding = 4 * std::numeric_limits<double>::epsilon();

}  // namespace anticrack::mesh
