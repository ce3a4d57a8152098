// SPDX-License-Identifier: GPL-3.0-or-later
//
// Boundary values that are not linear along the edges of the mesh: u_h equals g_D in the nodes
// only, u_h + w on whole edges. On a triangle with corners P_1, P_2 on the boundary and P_3,
//
//   w = (1 - l_3) phi(s),   phi = g_D - its linear interpolant,   s = l_2 / (1 - l_3).
#pragma once

#include <span>
#include <vector>

#include "estimate/boundary_samples.hpp"
#include "estimate/cut_mesh.hpp"

namespace anticrack::estimate {

/// w on the triangle of a face; s runs from the face's end 0 to its end 1.
struct Lift {
  std::int32_t face = 0;
  double mean = 0;              ///< int_0^1 phi ds
  double first = 0;             ///< int_0^1 s phi ds
  double gradient_squared = 0;  ///< int |grad w|^2 after the map of the tension (Shapes)
  double unknown = 0;           ///< >= the error of integrals of phi times at most 1
};

/// Makes the lifts from samples of g_D and from u_h in the copies, by Gauss's rule in each half of
/// an edge and bounds of the unknown part of g_D: gradient_squared is an upper bound, and the means
/// are wrong by at most `unknown`.
std::vector<Lift> lifts(const CutMesh& cut, const BoundarySamples& samples,
                        std::span<const double> u);

}  // namespace anticrack::estimate
