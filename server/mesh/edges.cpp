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
  const auto use = [&](std::size_t corner) {
    const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
    return EdgeUse{triangles[corner], triangles[next], static_cast<std::int32_t>(corner / 3)};
  };
  // A counting sort by the lower node, then each node's few sides by the others.
  const std::size_t nodes = triangles.empty() ? 0 : at(std::ranges::max(triangles)) + 1;
  std::vector<std::size_t> end(nodes + 1, 0);
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    stop::look_at_turn<std::size_t{1} << 18>(c, listing);
    ++end[at(use(c).low())];
  }
  stop::look(listing);
  std::partial_sum(end.begin(), end.end(), end.begin());
  for (std::size_t c = triangles.size(); c-- > 0;) {
    stop::look_at_turn<std::size_t{1} << 18>(c, listing);
    _uses[--end[at(use(c).low())]] = use(c);
  }
  _first = std::move(end);  // it is now where each node begins
  for (std::size_t n = 0; n < nodes; ++n) {
    stop::look_at_turn<stop::quick>(n, listing);
    std::sort(_uses.begin() + static_cast<std::ptrdiff_t>(_first[n]),
              _uses.begin() + static_cast<std::ptrdiff_t>(_first[n + 1]),
              [](const EdgeUse& a, const EdgeUse& b) {
                return std::pair(a.high(), a.triangle) < std::pair(b.high(), b.triangle);
              });
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
