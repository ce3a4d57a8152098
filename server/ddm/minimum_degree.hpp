// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace anticrack::ddm {

/// A graph with vertex sets as machine words: up to 64 vertices to eliminate, up to 64 around them.
struct SmallGraph {
  static constexpr std::size_t most = 64;
  std::size_t size = 0;
  std::array<std::uint64_t, most> inside{};  ///< of each vertex: its neighbours, itself included
  std::array<std::uint64_t, most> around{};  ///< and those that stay
};

/// Minimum degree order with true degrees, ties by number. Destroys the graph. O(size^2).
void minimum_degree(SmallGraph& graph, std::array<std::int32_t, SmallGraph::most>& order);

}  // namespace anticrack::ddm
