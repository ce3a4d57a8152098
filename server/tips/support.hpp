// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangles around a tip, as far as nothing else is near.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"
#include "tips/places.hpp"

namespace anticrack::tips {

/// Triangles that are nearer to a tip than `radius`. No other part of an interface, no bend or
/// change of its own and no boundary is nearer.
struct Support {
  double radius = 0;
  double inner =
      0;  ///< a quarter of the triangles, but not too few, are nearer; at most radius / 2
  std::vector<std::int32_t> triangles;  ///< of the mesh
};

/// Most triangles of a support: more make its numbers no better than the mesh is elsewhere.
constexpr std::size_t most_triangles = 60'000;

/// Finds supports on one mesh. Keeps references to the mesh, the edges and their ends.
class Surroundings {
 public:
  /// `ends`: of mesh::edge_ends. O(m).
  Surroundings(const mesh::Mesh& mesh, const mesh::EdgeTable& edges,
               const std::vector<mesh::EdgeEnd>& ends);

  /// One value a triangle, 0 between calls; each thread has its own.
  using Marks = std::vector<char>;
  /// The support of a place without a reason. O(n log n) for the n triangles in it.
  Support of(const Place& place, Marks& seen) const;

 private:
  bool is_obstacle(std::int32_t a, std::int32_t b, const Place& place) const;

  const mesh::Mesh& _mesh;
  const mesh::EdgeTable& _edges;
  const std::vector<mesh::EdgeEnd>& _ends;
  std::vector<char> _on_interface;    ///< (nodes)
  std::vector<std::int32_t> _across;  ///< (sides i, i + 1) the triangle there; -1: none
};

}  // namespace anticrack::tips
