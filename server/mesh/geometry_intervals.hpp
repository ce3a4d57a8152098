// SPDX-License-Identifier: GPL-3.0-or-later
//
// How many pieces a curve is cut into.
#pragma once

#include <span>
#include <vector>

#include "mesh/geometry.hpp"

namespace anticrack::mesh {

/// Shares `total` intervals among curves by their lengths: largest remainder, at least one each
/// (so the sum is max(total, number of curves)); ties go to the curve that comes first.
/// Lengths positive. O(k log k) in the curves for a total of their order.
std::vector<int> apportion(std::span<const double> lengths, int total);

/// Section 8 of the paper: 80 intervals on all glue together, 80 on all the rest of the interface,
/// 80 on the outer boundary of each subdomain. For a plan of two faces that one interface parts.
void set_paper_intervals(Plan& plan);

/// Cuts curves that are long for what is near them into several, the pieces the shorter the nearer
/// they are: an edge is at most twice as long as the distance to a curve it has no point in common
/// with, or as the shortest curve at its end, and grows by `growth` per length away from there.
/// What `size` cuts short enough stays whole. At most `max_curves`, else errors::Error
/// (limit_exceeded). O(c^2).
void cut_near(Plan& plan, double size, double growth, std::size_t max_curves);

/// Pieces of at most `size`.
void set_intervals(Plan& plan, double size);

/// Of the straight line from its first point to its last.
double length_of(const Plan& plan, const PlannedCurve& curve) noexcept;

}  // namespace anticrack::mesh
