// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edges.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesh {
namespace {

constexpr const char* listing = "listing the edges of a mesh";

}  // namespace

EdgeTable::EdgeTable(std::span<const std::int32_t> triangles) : _uses(triangles.size()) {
  // A counting sort by the lower node, then each node's few sides by the others.
  const std::size_t nodes = triangles.empty() ? 0 : at(std::ranges::max(triangles)) + 1;
  const auto each_side = [&](const auto& visit) {
    for (std::size_t t = 0; t < triangles.size() / 3; ++t) {
      stop::look_at_turn<std::size_t{1} << 17>(t, listing);
      const std::int32_t* const node = &triangles[3 * t];
      const auto triangle = static_cast<std::int32_t>(t);
      visit(EdgeUse{node[0], node[1], triangle});
      visit(EdgeUse{node[1], node[2], triangle});
      visit(EdgeUse{node[2], node[0], triangle});
    }
  };
  std::vector<std::uint32_t> begin(nodes + 2, 0);  // of the node before: filling moves it on
  each_side([&](const EdgeUse& use) { ++begin[at(use.low()) + 2]; });
  stop::look(listing);
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  each_side([&](const EdgeUse& use) { _uses[begin[at(use.low()) + 1]++] = use; });
  begin.pop_back();
  _first = std::move(begin);
  const auto before = [](const EdgeUse& a, const EdgeUse& b) { return a.high() < b.high(); };
  for (std::size_t n = 0; n < nodes; ++n) {
    stop::look_at_turn<stop::quick>(n, listing);
    // They are in the order of triangles, which a stable sort keeps.
    const auto first = _uses.begin() + _first[n], last = _uses.begin() + _first[n + 1];
    if (last - first > 32) {
      std::stable_sort(first, last, before);
      continue;
    }
    for (auto sorted = first; sorted != last; ++sorted) {
      const EdgeUse use = *sorted;
      auto to = sorted;
      for (; to != first && before(use, to[-1]); --to) *to = to[-1];
      *to = use;
    }
  }
}

std::vector<bool> EdgeTable::boundary_nodes(std::size_t node_count) const {
  std::vector<bool> found(node_count, false);
  each([&](std::span<const EdgeUse> uses) {
    if (uses.size() == 1) found[at(uses[0].from)] = found[at(uses[0].to)] = true;
  });
  return found;
}

std::span<const EdgeUse> EdgeTable::find(std::int32_t a, std::int32_t b) const noexcept {
  const auto [low, high] = std::minmax(a, b);
  if (at(low) + 1 >= _first.size()) return {};
  const auto own = std::span(_uses).subspan(_first[at(low)], _first[at(low) + 1] - _first[at(low)]);
  const EdgeUse edge{low, high, 0};
  const auto [begin, end] = std::equal_range(
      own.begin(), own.end(), edge,
      [](const EdgeUse& one, const EdgeUse& other) { return one.high() < other.high(); });
  return {begin, end};
}

}  // namespace anticrack::mesh
