// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edges.hpp"

#include <algorithm>
#include <tuple>

namespace anticrack::mesh {

EdgeTable::EdgeTable(std::span<const std::int32_t> triangles) {
  _uses.reserve(triangles.size());
  for (std::size_t t = 0; 3 * t + 2 < triangles.size(); ++t) {
    for (std::size_t side = 0; side < 3; ++side) {
      _uses.push_back({triangles[3 * t + side], triangles[3 * t + (side + 1) % 3],
                       static_cast<std::int32_t>(t)});
    }
  }
  std::sort(_uses.begin(), _uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tuple(a.low(), a.high(), a.triangle) < std::tuple(b.low(), b.high(), b.triangle);
  });
}

std::span<const EdgeUse> EdgeTable::find(std::int32_t a, std::int32_t b) const noexcept {
  const auto key = std::pair(std::min(a, b), std::max(a, b));
  const auto first =
      std::lower_bound(_uses.begin(), _uses.end(), key, [](const EdgeUse& use, const auto& wanted) {
        return std::pair(use.low(), use.high()) < wanted;
      });
  auto last = first;
  while (last != _uses.end() && last->low() == key.first && last->high() == key.second) ++last;
  return {first, last};
}

}  // namespace anticrack::mesh
