// SPDX-License-Identifier: GPL-3.0-or-later
//
// How many pieces a curve is cut into.
#pragma once

#include <span>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// Distributes `total` intervals over curves by length, which is positive: largest remainder, at
/// least one each (so the sum is max(total, curves)); ties go to the earlier curve.
/// O(k log k) for k curves and a total of that order.
std::vector<int> apportion(std::span<const double> lengths, int total);

/// Section 8 of the paper: 80 intervals on all glue together, 80 on the rest of the interface, 80
/// on the outer boundary of each subdomain. For a plan of two faces and one interface.
void set_paper_intervals(Plan& plan);

/// Cuts curves that are too long for what is near them: an edge is at most twice as long as the
/// distance to a curve it shares no point with, or as the shortest curve at its end, and may grow
/// by `growth` per unit length away from there. Curves that `size` makes short enough stay whole.
/// Throws errors::Error (limit_exceeded) beyond `max_curves`. O(c^2).
void cut_near(Plan& plan, double size, double growth, std::size_t max_curves);

/// Replaces the plan's curves. `pieces`: for each old curve, the new ones it became, in its own
/// direction; empty for a curve that was removed.
void replace_curves(Plan& plan, std::vector<PlannedCurve> curves,
                    const std::vector<std::vector<int>>& pieces);

/// Sets the intervals of each curve to pieces of at most `size`.
void set_intervals(Plan& plan, double size);

/// Distance of its end points.
double length_of(const Plan& plan, const PlannedCurve& curve) noexcept;

}  // namespace anticrack::mesh
