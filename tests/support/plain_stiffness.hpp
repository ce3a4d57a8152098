// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fem/triangulation.hpp"

namespace anticrack::testing {

/// The stiffness of all nodes, both triangles stored, entry by entry as the formula has it:
/// K_ij = T int grad(phi_i).grad(phi_j) dx.
inline Eigen::SparseMatrix<double> plain_stiffness(const fem::Triangulation& part,
                                                   double tension = 1) {
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  entries.reserve(9 * part.triangle_count());
  for (std::size_t t = 0; t < part.triangle_count(); ++t) {
    const std::int32_t* node = &part.triangles[3 * t];
    std::array<std::array<double, 2>, 3> edge{};  // edge[a] is opposite to corner a
    for (std::size_t a = 0; a < 3; ++a) {
      const auto from = 2 * static_cast<std::size_t>(node[(a + 1) % 3]);
      const auto to = 2 * static_cast<std::size_t>(node[(a + 2) % 3]);
      edge[a] = {part.xy[to] - part.xy[from], part.xy[to + 1] - part.xy[from + 1]};
    }
    const double twice_area = edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const double dot = edge[a][0] * edge[b][0] + edge[a][1] * edge[b][1];
        entries.emplace_back(node[a], node[b], tension * (dot / (2.0 * twice_area)));
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(part.node_count());
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace anticrack::testing
