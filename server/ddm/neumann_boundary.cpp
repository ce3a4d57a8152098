// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/neumann_boundary.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "base/at.hpp"
#include "mesh/edges.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

/// The index 3t + k of the side that goes from corner k of triangle t to the next corner.
std::size_t corner(const mesh::Mesh& mesh, const mesh::EdgeUse& use) {
  const std::int32_t* node = &mesh.triangles[3 * at(use.triangle)];
  return 3 * at(use.triangle) + at(std::find(node, node + 3, use.from) - node);
}

/// The index of each triangle of the mesh in its subdomain.
std::vector<std::size_t> places(const Decomposition& decomposition, std::size_t triangles) {
  std::vector<std::size_t> result(triangles);
  for (const Subdomain& subdomain : decomposition.subdomains)
    for (std::size_t k = 0; k < subdomain.triangle.size(); ++k)
      result[at(subdomain.triangle[k])] = k;
  return result;
}

using Ends = std::pair<std::int32_t, std::int32_t>;

std::map<Ends, double> stretches(const mesh::Mesh& mesh) {
  std::map<Ends, double> result;
  for (const mesh::ChordEdge& edge : mesh.chords)
    result[std::minmax(edge.a, edge.b)] = edge.stretch;
  return result;
}

}  // namespace

const NeumannBoundary::Edges& NeumannBoundary::of(std::size_t subdomain) const {
  const std::vector<Edges>& edges = _edges.get([this] {
    std::vector<Edges> result(_decomposition.subdomains.size());
    const std::vector<std::size_t> local = places(_decomposition, _mesh.triangle_count());
    const mesh::EdgeTable table(_mesh.triangles);
    std::vector<bool> held(_mesh.triangles.size(), false);
    for (const auto& [a, b] : _mesh.dirichlet)
      for (const mesh::EdgeUse& use : table.find(a, b)) held[corner(_mesh, use)] = true;
    const std::map<Ends, double> stretch = stretches(_mesh);
    std::size_t turn = 0;
    table.each([&](std::span<const mesh::EdgeUse> uses) {
      stop::look_at_turn<stop::quick>(turn++, "finding the boundary that tractions act on");
      const std::size_t free = corner(_mesh, uses[0]);
      if (uses.size() != 1 || held[free]) return;
      const std::size_t s = at(_mesh.subdomain[free / 3]), k = free % 3;
      const std::int32_t* node = &_decomposition.subdomains[s].part.triangles[3 * local[free / 3]];
      result[s].nodes.push_back({node[k], node[(k + 1) % 3]});
      if (stretch.empty()) return;
      const auto on_chord = stretch.find({uses[0].low(), uses[0].high()});
      result[s].stretch.push_back(on_chord == stretch.end() ? 0 : on_chord->second);
    });
    return result;
  });
  return edges[subdomain];
}

std::size_t NeumannBoundary::bytes() const noexcept {
  std::size_t bytes = 0;
  if (const std::vector<Edges>* edges = _edges.known())
    for (const Edges& on_subdomain : *edges)
      bytes += on_subdomain.nodes.capacity() * sizeof(on_subdomain.nodes[0]) +
               on_subdomain.stretch.capacity() * sizeof(double);
  return bytes;
}

}  // namespace anticrack::ddm
