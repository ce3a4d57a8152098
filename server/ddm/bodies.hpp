// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inclusions as rigid bodies: which inclusions form one body, and how each body may move.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ddm/cut_steps.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::ddm {

/// Inclusions that share nodes are one body. Its motion is u = A + sum_k C_k axis_k.(x - centre).
/// There are no axes unless all its inclusions tilt; then one if its nodes lie on a line, else two.
struct Body {
  std::vector<std::int32_t> inclusions;  ///< ascending
  mesh::Point centre{};                  ///< of the bounding box of its nodes
  std::vector<mesh::Point> axes;         ///< directions over half the body's size: C_k has u's unit
  std::optional<double> fixed;           ///< the value at which it is held
  std::vector<std::int32_t> on_dirichlet;  ///< its nodes on the Dirichlet boundary, ascending
};

struct Bodies {
  std::vector<Body> bodies;         ///< in the order of their first inclusions
  std::vector<std::int32_t> of;     ///< (inclusions) index of its body
  std::vector<mesh::Point> centre;  ///< (inclusions) of the bounding box of its own nodes
};

/// Finds the bodies. Throws errors::Error: mesh_invalid for an inclusion without edges;
/// invalid_argument for a body fixed at two values. O(k) for k edges.
Bodies find_bodies(const mesh::Mesh& mesh, const Sides& sides);

/// axis_k.(x - centre), the factor of C_k.
double lever(const Body& body, std::size_t axis, const mesh::Point& x);

}  // namespace anticrack::ddm
