// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/elimination_order.hpp"

#include <bit>

namespace anticrack::ddm {

void minimum_degree(SmallGraph& graph, std::array<std::int32_t, SmallGraph::most>& order) {
  constexpr std::uint64_t one = 1;
  std::array<int, SmallGraph::most> degree{};
  std::uint64_t left = 0;
  for (std::size_t v = 0; v < graph.size; ++v) {
    left |= one << v;
    degree[v] = std::popcount(graph.inside[v]) + std::popcount(graph.around[v]);
  }
  for (std::size_t i = 0; i < graph.size; ++i) {
    auto next = static_cast<std::size_t>(std::countr_zero(left));
    for (std::uint64_t rest = left; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<std::size_t>(std::countr_zero(rest));
      next = degree[v] < degree[next] ? v : next;
    }
    order[i] = static_cast<std::int32_t>(next);
    left &= ~(one << next);
    // The neighbours of an eliminated vertex become neighbours of each other.
    const std::uint64_t inside = graph.inside[next] & left, around = graph.around[next];
    for (std::uint64_t rest = inside; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<std::size_t>(std::countr_zero(rest));
      graph.inside[v] = (graph.inside[v] | inside) & left;
      graph.around[v] |= around;
      degree[v] = std::popcount(graph.inside[v]) + std::popcount(graph.around[v]);
    }
  }
}

}  // namespace anticrack::ddm
