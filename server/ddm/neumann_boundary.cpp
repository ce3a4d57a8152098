// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/neumann_boundary.hpp"

#include <algorithm>
#include <utility>

#include "mesh/at.hpp"

namespace anticrack::ddm {
namespace {

using EdgeKey = std::pair<std::int32_t, std::int32_t>;

/// An edge of a triangle, kept at the lower one of its two nodes.
struct Use {
  std::int32_t high;
  std::int32_t corner;  // 3t + k
};

EdgeKey edge_of(const mesh::Mesh& mesh, std::size_t corner) {
  const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
  return std::minmax(mesh.triangles[corner], mesh.triangles[next]);
}

/// Each as 3t + k when it runs from corner k to corner k+1 of triangle t.
std::vector<std::int32_t> free_corners(const mesh::Mesh& mesh) {
  std::vector<std::size_t> end(mesh.node_count() + 1, 0);  // of each node's uses
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) ++end[at(edge_of(mesh, c).first) + 1];
  for (std::size_t n = 1; n < end.size(); ++n) end[n] += end[n - 1];
  std::vector<Use> uses(mesh.triangles.size());
  for (std::size_t c = mesh.triangles.size(); c-- > 0;) {
    const auto [low, high] = edge_of(mesh, c);
    uses[--end[at(low) + 1]] = {high, static_cast<std::int32_t>(c)};
  }
  // end[n + 1] is now where node n begins.
  std::vector<EdgeKey> held;
  held.reserve(mesh.dirichlet.size());
  for (const auto& edge : mesh.dirichlet) held.push_back(std::minmax(edge[0], edge[1]));
  std::sort(held.begin(), held.end());
  std::vector<std::int32_t> result;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    const auto first = uses.begin() + static_cast<std::ptrdiff_t>(end[n + 1]);
    const auto last =
        n + 2 < end.size() ? uses.begin() + static_cast<std::ptrdiff_t>(end[n + 2]) : uses.end();
    std::sort(first, last, [](const Use& a, const Use& b) { return a.high < b.high; });
    for (auto use = first; use != last;) {
      const auto next =
          std::find_if(use, last, [use](const Use& other) { return other.high != use->high; });
      const EdgeKey key{static_cast<std::int32_t>(n), use->high};
      if (next - use == 1 && !std::binary_search(held.begin(), held.end(), key))
        result.push_back(use->corner);
      use = next;
    }
  }
  return result;
}

/// Of each triangle of the mesh in its subdomain.
std::vector<std::size_t> places(const Decomposition& decomposition, std::size_t triangles) {
  std::vector<std::size_t> result(triangles);
  for (const Subdomain& subdomain : decomposition.subdomains)
    for (std::size_t k = 0; k < subdomain.triangle.size(); ++k)
      result[at(subdomain.triangle[k])] = k;
  return result;
}

}  // namespace

const NeumannBoundary::Edges& NeumannBoundary::of(std::size_t subdomain) const {
  const std::vector<Edges>& edges = _edges.get([this] {
    std::vector<Edges> result(_decomposition.subdomains.size());
    const std::vector<std::size_t> local = places(_decomposition, _mesh.triangle_count());
    for (const std::int32_t corner : free_corners(_mesh)) {
      const std::size_t s = at(_mesh.subdomain[at(corner / 3)]), k = at(corner % 3);
      const std::int32_t* node =
          &_decomposition.subdomains[s].part.triangles[3 * local[at(corner / 3)]];
      result[s].push_back({node[k], node[(k + 1) % 3]});
    }
    return result;
  });
  return edges[subdomain];
}

std::size_t NeumannBoundary::bytes() const noexcept {
  std::size_t bytes = 0;
  if (const std::vector<Edges>* edges = _edges.known())
    for (const Edges& on_subdomain : *edges)
      bytes += on_subdomain.capacity() * sizeof(on_subdomain[0]);
  return bytes;
}

}  // namespace anticrack::ddm
