// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace anticrack::ddm {

/// A graph so small that sets of its vertices are machine words: up to 64 vertices that are to be
/// eliminated, and up to 64 around them that stay.
struct SmallGraph {
  static constexpr std::size_t most = 64;
  std::size_t size = 0;
  std::array<std::uint64_t, most> inside{};  ///< of each vertex: its neighbours, itself included
  std::array<std::uint64_t, most> around{};  ///< and those that stay
};

/// The vertices in the order in which each has the fewest neighbours left when it is eliminated,
/// ties in the order of their numbers; true degrees. Spoils the graph. O(size^2).
void minimum_degree(SmallGraph& graph, std::array<std::int32_t, SmallGraph::most>& order);

}  // namespace anticrack::ddm
