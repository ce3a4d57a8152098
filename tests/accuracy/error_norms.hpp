// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far an answer is from an exact solution.
#pragma once

#include "contact/answer.hpp"
#include "mesh/mesh.hpp"
#include "support/exact_solutions.hpp"

namespace anticrack::accuracy {

/// (int |grad u - grad u_h|^2)^{1/2} over the membrane, T = 1, by quadrature on every triangle; in
/// triangles at a tip of the crack in coordinates that make r^{-3/4} and r^{-1/2} smooth. Right to
/// about 1e-3. The answer must carry its fields and no subdomain may have a slit. O(m).
double energy_error(const mesh::Mesh& mesh, const contact::Answer& answer,
                    const testing::ExactSolution& exact);

struct JumpError {
  double largest = 0;  ///< over the nodes of the crack
  double l2 = 0;       ///< of the piecewise linear [u_h], (int ([u] - [u_h])^2 ds)^{1/2}
};
/// On the first interface, which lies on the x axis.
JumpError jump_error(const mesh::Mesh& mesh, const contact::Answer& answer,
                     const testing::ExactSolution& exact);

}  // namespace anticrack::accuracy
