// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "fem/scalar_field.hpp"

namespace anticrack::fem {

struct Point {
  double x;
  double y;
};

/// Corners counterclockwise, area > 0.
using Triangle = std::array<Point, 3>;

/// Of the plane, length unit squared; the longest of its three sides.
double area(const Triangle& triangle) noexcept;
double longest_edge(const Triangle& triangle) noexcept;

/// Greatest absolute coordinate: positions are known to about 1e-16 of it, however small the
/// triangle.
double magnitude(const Triangle& triangle) noexcept;

/// Factor by which points on the edges are drawn towards the centroid before the field is
/// evaluated: 1 - 3 inset, where inset is 1e-13 of the height, or what rounding of the coordinates
/// asks for. So a triangle is asked for its own side of a jump along its edge.
double drawn_in(const Triangle& triangle) noexcept;

/// int f phi_i of one triangle by one rule, and how far to trust it.
struct SampledTriangle {
  std::array<double, 3> nodal{};
  double absolute = 0;       ///< int |f|
  double error = 0;          ///< of the worst nodal value, estimated
  double product_error = 0;  ///< what a rule of degree 12 would leave, if the decay goes on
  bool rough = false;        ///< no polynomial fits the samples well: a break is likely
};

/// 15 points: the corners and the middles of the edges (drawn in) and 9 inside. Positive weights,
/// degree 6, so f phi_i is exact for f of degree 5. The 5 functionals of the samples that vanish on
/// cubics measure what a cubic misses; how much less that is than its terms of degree 2 and 3 tells
/// the decay of the expansion, hence the error of the rule (null rules: J. Berntsen, T. Espelid,
/// Error estimation in automatic quadrature routines, ACM TOMS 17, 1991). A break between any two
/// of the samples stops the decay.
SampledTriangle sample_triangle(const Triangle& triangle, CountedField& field);

}  // namespace anticrack::fem
