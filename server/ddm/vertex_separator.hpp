// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the smallest vertex separator of two sides of a graph, by a maximal flow of vertex-disjoint
// paths (Menger). It smooths the cuts of a nested dissection, after C. Ashcraft and J. Liu,
// Applications of the Dulmage-Mendelsohn decomposition and network flow to graph bisection
// improvement, SIAM J. Matrix Anal. Appl. 19 (1998).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace anticrack::ddm {

/// A band of vertices 0..n-1 between two sides.
struct Band {
  std::vector<std::int32_t> begin;      ///< (n+1) into `neighbour`
  std::vector<std::int32_t> neighbour;  ///< each edge occurs at both its ends
  std::vector<char> meets_first;        ///< (n) whether a neighbour is on the first side
  std::vector<char> meets_second;       ///< (n) whether a neighbour is on the second side

  /// The number of vertices.
  std::size_t size() const noexcept { return begin.size() - 1; }
};

enum class Part : char { first, second, separator };

/// Finds separators and reuses its memory for the next band. For one thread.
class VertexSeparator {
 public:
  /// The part of each vertex of the band. Of the smallest separators, the one nearest to the first
  /// side and the one nearest to the second are compared, and the one that leaves the sides more
  /// equal is taken. `first` and `second`: sizes of the sides without the band. Valid until the
  /// next call. Dinic's algorithm, O(e sqrt(s)) for a separator of s vertices; a few passes over
  /// the band in practice.
  const std::vector<Part>& find(const Band& band, std::ptrdiff_t first, std::ptrdiff_t second);

 private:
  template <class Reach>
  void each_before(const Band& band, std::int32_t state, const Reach& reach) const;
  template <class Reach>
  void each_after(const Band& band, std::int32_t state, const Reach& reach) const;
  std::int32_t find_levels(const Band& band);
  std::int32_t step(const Band& band, std::int32_t state);
  bool find_way(const Band& band, std::int32_t from);
  void push();
  std::ptrdiff_t assign(Part near, std::vector<Part>& parts) const;
  void search_from_first(const Band& band);

  // A vertex is entered once at most, so it has two states, 2v when entered and 2v + 1 when left.
  std::vector<std::int32_t> _previous, _next;  // vertices before and after on the path through it
  std::vector<std::int32_t> _level;       // of each state: steps to a side; -1: unknown, dead end
  std::vector<std::int32_t> _cursor;      // of each vertex: the neighbour to try next
  std::vector<std::int32_t> _open, _way;  // states
  std::vector<Part> _part, _other;
};

}  // namespace anticrack::ddm
