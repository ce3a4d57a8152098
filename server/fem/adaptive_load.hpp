// SPDX-License-Identifier: GPL-3.0-or-later
//
// The load vector of a field that may jump where the mesh does not know it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>

#include "fem/scalar_field.hpp"

namespace anticrack::fem {

struct IntegrationLimits {
  double relative_tolerance = 1e-10;
  /// First, for each; then what is left of the total goes to the worst, a sixteenth of it to each.
  std::size_t evaluations_per_triangle = 20'000;
  /// For all, next to the 15 that every triangle gets.
  std::size_t evaluations = 10'000'000;
};

struct IntegrationReport {
  /// Sum of the triangles' estimated errors over int |f| (0 for f = 0). Above the tolerance only if
  /// a limit was met: worth a warning to the user.
  double relative_error_estimate = 0;
  std::size_t evaluations = 0;
  std::size_t cut_triangles = 0;  ///< triangles in which a jump or a kink was found
};

/// load_i = int f phi_i dx, shape (n), for the P1 hat functions of a triangulation.
/// `xy` (n,2) and `triangles` (m,3) row-major, index base 0, counterclockwise, areas > 0.
///
/// Where f is piecewise smooth, the load is right to relative_tolerance of int |f|: each triangle
/// of area a is allowed relative_tolerance / 2 of (a mean|f| + its own int |f|), so nodal values
/// are as accurate, relative to mean |f| times the area of the node's triangles. Where triangles
/// are so small that rounding of the coordinates moves a jump further than that, rounding decides.
///
/// 1. 15 samples a triangle (sampled_triangle.hpp): exact for f of degree 5, enough where f is
///    smooth. Smooth but steep: quartered, up to three times.
/// 2. Rough triangles are swept with the jumps located on lines (cut_triangle.hpp).
/// 3. A curve may enter a neighbour by a cap that its samples miss, so the edges shared with cut
///    triangles, and those on the boundary if there is any cut, are looked at more closely.
///
/// Missed, and not in the estimate, is what no sample sees: islands and strips thinner than about a
/// quarter of a triangle that touch none of its 15 points; caps and tips narrower than some 1/100
/// of an edge that poke into a triangle from a neighbour, such as the corner where two jumps end
/// (one or two of a hundred such corners, errors of 1e-9 to 1e-6); caps at the boundary of a
/// subdomain in which f is smooth otherwise; jumps below the tolerance. Kinks are integrated as
/// well as jumps; where the slope is infinite the limits may end the work first.
///
/// Deterministic. Memory O(m). 15 m evaluations where f is smooth, some 1500 for a
/// triangle with one jump. A triangle whose area is zero to rounding has no load. Throws what f
/// throws, and errors::Error (cancelled) soon after `stop` is requested.
IntegrationReport integrate_load(std::span<const double> xy,
                                 std::span<const std::int32_t> triangles, const ScalarField& f,
                                 std::span<double> load, const IntegrationLimits& limits = {},
                                 std::stop_token stop = {});

}  // namespace anticrack::fem
