// SPDX-License-Identifier: GPL-3.0-or-later
//
// An order of elimination that leaves little fill, from the coordinates of the nodes of a mesh:
// each set of nodes is cut where its halves lie on two sides of a line or a circle, the fewest
// nodes that part the halves come after both, and the halves are cut in turn.
//
// A. George, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10 (1973);
// R. Lipton, D. Rose and R. Tarjan, Generalized nested dissection, SIAM J. Numer. Anal. 16 (1979);
// by coordinates: M. Heath and P. Raghavan, A Cartesian parallel nested dissection algorithm, SIAM
// J. Matrix Anal. Appl. 16 (1995); with circles, for meshes graded to points: G. Miller, S.-H.
// Teng, W. Thurston and S. Vavasis, Geometric separators for finite-element meshes, SIAM J. Sci.
// Comput. 19 (1998).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace anticrack::ddm {

/// Vertices 0..n-1.
struct Graph {
  std::vector<std::int32_t> begin = {0};  ///< (n+1) into `neighbour`
  std::vector<std::int32_t>
      neighbour;  ///< each edge from both its ends, none of a vertex to itself

  /// Vertices.
  std::size_t size() const noexcept { return begin.size() - 1; }
};

/// The vertices in the order of their elimination. `xy`: (n,2) row-major, or longer. Any graph and
/// any coordinates are allowed; they cost fill, not correctness. The same for the same input. Time
/// O(n log n) and fill O(n log n) for triangulations; fastest where nodes that are near each other
/// have near numbers. 50 bytes a vertex beside the graph.
std::vector<std::int32_t> nested_dissection(const Graph& graph, std::span<const double> xy);

}  // namespace anticrack::ddm
