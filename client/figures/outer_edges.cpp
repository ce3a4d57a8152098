// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/mesh_layers.hpp"

#include <algorithm>

namespace anticrack::figures {

std::vector<Edge> outer_edges(const results::Mesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      edges.push_back(std::minmax<std::int32_t>(
          {mesh.triangles[3 * t + c], mesh.triangles[3 * t + (c + 1) % 3]}));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> outer;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool shared =
        (i > 0 && edges[i - 1] == edges[i]) || (i + 1 < edges.size() && edges[i + 1] == edges[i]);
    if (!shared) outer.push_back(edges[i]);
  }
  return outer;
}

}  // namespace anticrack::figures
