// SPDX-License-Identifier: GPL-3.0-or-later
//
// Newest-vertex bisection of a conforming triangulation, conforming after every step.
//
// Bisection joins the midpoint of a triangle's reference edge to the opposite corner; the reference
// edges of the children are the other two edges of the parent. The first reference edge is the
// longest one; among equal ones, that with the smaller (low, high) pair of nodes, which makes the
// order strict. A mesh that was bisected before (Mesh::bisection_bound) keeps its reference edges:
// `finish` makes them the sides from corner 0 to corner 1.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesh/edges.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// The work that bisection names when it looks at its stop token.
constexpr const char* bisecting = "bisecting a mesh";

/// The reference edge of each triangle as a side (0, 1, 2: from corner 0, 1, 2 to the next), shape
/// (m). O(m).
std::vector<std::uint8_t> reference_sides(const Mesh& mesh, const EdgeTable& edges);

/// Construct it, call `bisect` at will, then `finish`. `base` must outlive it. For one thread.
class Bisection {
 public:
  /// Throws errors::Error (mesh_invalid) if three triangles share an edge, or two lie on the same
  /// side of one. O(m log m).
  Bisection(const Mesh& base, std::size_t max_triangles);

  /// The number of triangles of the mesh as it is now.
  std::size_t triangle_count() const noexcept { return _subdomain.size(); }
  /// The triangle of the base of which this triangle is a part.
  std::int32_t origin(std::size_t triangle) const noexcept { return _origin[triangle]; }
  /// The corners of a triangle, counterclockwise.
  std::array<Point, 3> corners(std::size_t triangle) const noexcept;

  /// Bisects a triangle, after the neighbours that must be bisected for the mesh to conform. One
  /// child takes its number, the other the next free one. Returns false if the mesh would exceed
  /// `max_triangles`; a part of the work may be done then. O(1) amortised over all calls.
  [[nodiscard]] bool bisect(std::size_t triangle);

  /// The mesh as it is now, with interfaces and Dirichlet edges cut likewise, and its
  /// `bisection_bound`. O(n log n).
  Mesh finish() &&;

 private:
  std::int32_t midpoint(std::int32_t a, std::int32_t b);
  std::int32_t append_triangle(std::int32_t like);
  void bisect_along_reference(std::int32_t t);

  const Mesh& _base;
  std::size_t _max_triangles;
  std::vector<double> _xy;
  std::vector<std::array<std::int32_t, 2>> _parents;  ///< ends of each new node's edge
  /// Corners counterclockwise from the start of the reference edge: the newest vertex is the third.
  std::vector<std::array<std::int32_t, 3>> _corners;
  /// Triangle across the side from corner i to the next, -1: none; so [0] is across the reference
  /// edge.
  std::vector<std::array<std::int32_t, 3>> _across;
  std::vector<std::int32_t> _subdomain;
  std::vector<std::int32_t> _origin;
  std::vector<std::int32_t> _waiting;
};

}  // namespace anticrack::mesh
