// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/lazy.hpp"
#include "ddm/decomposition.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::ddm {

/// The Neumann boundary: edges of one triangle that are not in Mesh::dirichlet. Found at the first
/// call, which only tractions make: O(m), 12 bytes a side of a triangle meanwhile. Thread-safe.
class NeumannBoundary {
 public:
  /// Refers to both; the decomposition is the mesh's.
  NeumannBoundary(const mesh::Mesh& mesh, const Decomposition& decomposition)
      : _mesh(mesh), _decomposition(decomposition) {}

  using Edges = std::vector<std::array<std::int32_t, 2>>;
  /// Local nodes of the edges on a subdomain, counterclockwise about their triangle.
  const Edges& of(std::size_t subdomain) const;
  std::size_t bytes() const noexcept;

 private:
  const mesh::Mesh& _mesh;
  const Decomposition& _decomposition;
  base::Lazy<std::vector<Edges>> _edges;  // of each subdomain
};

}  // namespace anticrack::ddm
