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

/// The Neumann boundary: the edges of only one triangle that are not in Mesh::dirichlet. It is
/// found at the first call, which only tractions make: O(m), with 12 bytes for each side of a
/// triangle meanwhile. Thread-safe.
class NeumannBoundary {
 public:
  /// Keeps references to both; the decomposition must be that of the mesh.
  NeumannBoundary(const mesh::Mesh& mesh, const Decomposition& decomposition)
      : _mesh(mesh), _decomposition(decomposition) {}

  struct Edges {
    std::vector<std::array<std::int32_t, 2>> nodes;  ///< local, counterclockwise about the triangle
    std::vector<double> stretch;  ///< as mesh::ChordEdge::stretch; empty: the mesh has no chords
  };
  /// Edges of a subdomain.
  const Edges& of(std::size_t subdomain) const;
  std::size_t bytes() const noexcept;

 private:
  const mesh::Mesh& _mesh;
  const Decomposition& _decomposition;
  base::Lazy<std::vector<Edges>> _edges;  // per subdomain
};

}  // namespace anticrack::ddm
