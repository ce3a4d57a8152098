// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fem/sampled_triangle.hpp"

namespace anticrack::fem {

/// Where a field breaks along an edge of a triangle (drawn in, see drawn_in).
struct EdgeBreaks {
  std::vector<Point> jumps;
  std::vector<Point> kinks;
};

/// Edge i runs from corner i to corner (i + 1) % 3. 97 points and some 40 more for each break;
/// missed is what comes and goes between two points. `tolerance`: error of f in the mean along the
/// edge that does not matter.
EdgeBreaks scan_edge(const Triangle& triangle, std::size_t edge, double tolerance,
                     CountedField& field);

/// int f phi_i of one triangle.
struct CutTriangle {
  std::array<double, 3> nodal{};
  double error = 0;  ///< of the worst nodal value, estimated
  bool cut = false;  ///< a jump or a kink was found
};

/// Integrates f phi_i over a triangle in which f breaks along unknown curves, `edges` being where
/// it breaks on the edges: iterated piecewise integration (PiecewiseQuadrature). The outer variable
/// runs along the chord between the two breaks farthest apart, in panels that end at the breaks on
/// the edges and at the corners; the inner integral runs across, so a jump meets it steeply and is
/// located on each line to 1e-13. Straight jumps then leave polynomials, which the rule integrates
/// exactly; curved ones converge at the rules' order; crossings and ends of jumps inside are breaks
/// of the outer integrand, found like those of the inner one. `tolerance`: of a nodal value.
/// A line costs some 45 evaluations for each jump, a triangle with one jump about 30 lines.
CutTriangle integrate_cut_triangle(const Triangle& triangle, const std::array<EdgeBreaks, 3>& edges,
                                   double tolerance, CountedField& field);

}  // namespace anticrack::fem
