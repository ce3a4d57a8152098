// SPDX-License-Identifier: GPL-3.0-or-later
//
// A fill-reducing order from the coordinates of a mesh's nodes: a set of nodes is cut by a line or
// circle, a smallest separator of the halves comes last, and the halves are cut in turn.
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

/// The vertices in order of elimination. `xy`: (n,2) row-major, or longer. Valid for any graph and
/// any coordinates; deterministic. Time and fill O(n log n) for triangulations; fastest if nearby
/// nodes have nearby numbers. 50 bytes a vertex besides the graph.
std::vector<std::int32_t> nested_dissection(const Graph& graph, std::span<const double> xy);

}  // namespace anticrack::ddm
