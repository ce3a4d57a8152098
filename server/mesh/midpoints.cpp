// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/midpoints.hpp"

#include <algorithm>

namespace anticrack::mesh {
namespace {

std::uint64_t edge_key(std::int32_t a, std::int32_t b) noexcept {
  const auto low = static_cast<std::uint64_t>(std::min(a, b));
  const auto high = static_cast<std::uint64_t>(std::max(a, b));
  return low << 32U | high;
}

/// Calls `piece(from, to)` for the pieces of the edge a -> b, in order.
template <class Piece>
void each_piece(std::int32_t a, std::int32_t b, const Midpoints& midpoints,
                std::vector<std::int32_t>& targets, Piece&& piece) {
  targets.assign(1, b);
  std::int32_t from = a;
  while (!targets.empty()) {
    const std::int32_t to = targets.back();
    const std::int32_t middle = midpoints.find(from, to);
    if (middle >= 0) {
      targets.push_back(middle);
    } else {
      piece(from, to);
      from = to;
      targets.pop_back();
    }
  }
}

}  // namespace

Midpoints::Midpoints(std::int32_t first, std::span<const std::array<std::int32_t, 2>> parents) {
  _cuts.reserve(parents.size());
  std::int32_t node = first;
  for (const auto& [a, b] : parents) _cuts.emplace_back(edge_key(a, b), node++);
  std::sort(_cuts.begin(), _cuts.end());
}

std::int32_t Midpoints::find(std::int32_t a, std::int32_t b) const noexcept {
  const std::uint64_t key = edge_key(a, b);
  const auto at = std::lower_bound(_cuts.begin(), _cuts.end(), key,
                                   [](const auto& cut, auto wanted) { return cut.first < wanted; });
  return at != _cuts.end() && at->first == key ? at->second : -1;
}

void cut_lines(Mesh& mesh, const Midpoints& midpoints) {
  std::vector<std::int32_t> targets;
  for (Interface& line : mesh.interfaces) {
    Interface cut{line.name, {line.nodes.front()}, {}, {}};
    for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
      each_piece(line.nodes[i], line.nodes[i + 1], midpoints, targets,
                 [&](std::int32_t, std::int32_t to) {
                   cut.nodes.push_back(to);
                   cut.kind.push_back(line.kind[i]);
                   cut.inclusion.push_back(line.inclusion[i]);
                 });
    }
    line = std::move(cut);
  }
  std::vector<std::array<std::int32_t, 2>> dirichlet;
  for (const auto& [a, b] : mesh.dirichlet) {
    each_piece(a, b, midpoints, targets, [&](std::int32_t from, std::int32_t to) {
      dirichlet.push_back({from, to});
    });
  }
  mesh.dirichlet = std::move(dirichlet);
}

}  // namespace anticrack::mesh
