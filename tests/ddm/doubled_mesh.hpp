// SPDX-License-Identifier: GPL-3.0-or-later
//
// The slow and obvious twin of ddm::cut: every triangle begins with three nodes of its own, and
// what must be equal is merged until nothing changes. No fans, no unions by rank, no locality.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::testing {

struct DoubledMesh {
  std::vector<int> value;  ///< (inclusions + 3m) of each A_j, then of each triangle's corner
  std::size_t values = 0;
  std::vector<char> fixed;              ///< (values) on the Dirichlet boundary
  std::vector<char> skeleton;           ///< (values) an A_j, or of a free interface node
  std::set<std::pair<int, int>> above;  ///< value >= value, everything that follows included
  bool crossing = false;  ///< what is left without implied conditions has a closed way round
  bool held = true;       ///< every value is joined by triangles to a fixed one

  Eigen::MatrixXd stiffness;  ///< (values, values)
  /// Schur complement on the skeleton's free values, in their order; zero value elsewhere fixed.
  Eigen::MatrixXd schur() const;
  /// Positions of the skeleton's values in `schur`, -1 for others.
  std::vector<int> position() const;
};

DoubledMesh double_mesh(const mesh::Mesh& mesh);

}  // namespace anticrack::testing
