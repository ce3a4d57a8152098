// SPDX-License-Identifier: GPL-3.0-or-later
//
// The edges of a triangulation and the triangles on either side of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::mesh {

/// One side of one triangle, walked in the triangle's direction from -> to; a counterclockwise
/// triangle is on the left.
struct EdgeUse {
  std::int32_t from = 0;
  std::int32_t to = 0;
  std::int32_t triangle = 0;

  /// The ends in order: equal for both triangles of an edge.
  std::int32_t low() const noexcept { return from < to ? from : to; }
  std::int32_t high() const noexcept { return from < to ? to : from; }
};

/// All sides of all triangles, sorted by (low, high), then by triangle. 12 bytes a side, 4 a node.
class EdgeTable {
 public:
  /// `triangles` (m,3) row-major. O(n + m) for n nodes with few edges each.
  explicit EdgeTable(std::span<const std::int32_t> triangles);

  /// The sides of the edge between two nodes, in either order; empty if there is none. O(1)
  /// for nodes with few edges.
  std::span<const EdgeUse> find(std::int32_t a, std::int32_t b) const noexcept;

  /// Calls `visit(std::span<const EdgeUse>)` once for each edge, in the order of (low, high).
  template <class Visit>
  void each(Visit&& visit) const {
    for (std::size_t i = 0; i < _uses.size();) {
      std::size_t end = i + 1;
      while (end < _uses.size() && same_edge(_uses[i], _uses[end])) ++end;
      visit(std::span<const EdgeUse>(_uses).subspan(i, end - i));
      i = end;
    }
  }

  /// Whether each of `node_count` nodes lies on an edge of one triangle. O(m).
  std::vector<bool> boundary_nodes(std::size_t node_count) const;

 private:
  static bool same_edge(const EdgeUse& a, const EdgeUse& b) noexcept {
    return a.low() == b.low() && a.high() == b.high();
  }

  std::vector<EdgeUse> _uses;
  std::vector<std::uint32_t> _first;  // (nodes + 1) of _uses, by the lower node
};

}  // namespace anticrack::mesh
