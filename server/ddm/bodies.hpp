// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inclusions as rigid bodies: which of them are one, and how each may move.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "ddm/cut_steps.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::ddm {

/// Inclusions that share nodes are one body. Its motion is u = A + sum_k C_k axis_k.(x - centre):
/// nothing but A unless all its inclusions tilt; one axis if its nodes lie on a line, else two.
struct Body {
  std::vector<std::int32_t> inclusions;  ///< ascending
  mesh::Point centre{};                  ///< of the bounding box of its nodes
  std::vector<mesh::Point> axes;         ///< directions over half the body's size: C_k has u's unit
  std::optional<double> fixed;           ///< held at this value
  std::vector<std::int32_t> on_dirichlet;  ///< its nodes on the Dirichlet boundary, ascending
};

struct Bodies {
  std::vector<Body> bodies;         ///< in the order of their first inclusions
  std::vector<std::int32_t> of;     ///< (inclusions) its body
  std::vector<mesh::Point> centre;  ///< (inclusions) of the bounding box of its own nodes
};

/// Throws errors::Error: mesh_invalid for an inclusion without edges; invalid_argument for one body
/// that is fixed at two values. O(k) for k edges.
Bodies find_bodies(const mesh::Mesh& mesh, const Sides& sides);

/// axis_k.(x - centre), the factor of C_k.
double lever(const Body& body, std::size_t axis, const mesh::Point& x);

}  // namespace anticrack::ddm
