// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include "ddm/cut_steps.hpp"
#include "mesh/at.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::operators {
namespace {

struct Size {
  double nodes = 0;
  double trace = 0;
};

/// Nodes of each subdomain, and those of them on interfaces, once for each side.
std::vector<Size> subdomain_sizes(const mesh::Mesh& mesh, const ddm::Sides& sides) {
  std::vector<Size> sizes(mesh.subdomains.size());
  std::vector<char> seen(mesh.node_count(), 0);
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const auto node = at(mesh.triangles[c]);
    if (sides.corner[c] < 0 && seen[node] == 0) {
      seen[node] = 1;
      sizes[at(mesh.subdomain[c / 3])].nodes += 1;
    }
  }
  for (const ddm::Side& side : sides.sides) {
    sizes[at(side.subdomain)].nodes += 1;
    sizes[at(side.subdomain)].trace += 1;
  }
  return sizes;
}

/// Upper bounds of the skeleton's unknowns and contacts.
struct SkeletonSize {
  double unknowns = 0;
  double contacts = 0;
};

/// A node has one unknown if all its edges are closed; otherwise up to one per side, and, if its
/// sides may touch, one contact fewer.
SkeletonSize skeleton_size(const mesh::Mesh& mesh, const ddm::Sides& sides) {
  std::vector<char> open(mesh.node_count(), 0), touches(open), seen(open);
  for (const ddm::CutEdge& edge : sides.edges) {
    const bool contact = edge.kind == mesh::Kind::crack || edge.kind == mesh::Kind::delaminated;
    for (const std::int32_t node : edge.node) {
      touches[at(node)] |= contact ? 1 : 0;
      open[at(node)] |= contact || edge.kind == mesh::Kind::free ? 1 : 0;
    }
  }
  SkeletonSize size{3 * static_cast<double>(mesh.inclusions.size()), 0};
  for (const ddm::Side& side : sides.sides) {
    const auto node = at(side.node);
    const bool another = seen[node] != 0;
    seen[node] = 1;
    size.unknowns += another && open[node] == 0 ? 0 : 1;
    size.contacts += another && touches[node] != 0 ? 1 : 0;
  }
  return size;
}

}  // namespace

std::size_t estimate_bytes(const mesh::Mesh& mesh) {
  // The factor of a planar graph ordered by nested dissection has O(n log n) entries; measured with
  // all other data per node: 30 to 42 bytes a node and log2(n), from 1 k to 2 M nodes. Dense: S and
  // the flexibility on the trace; H and W on the skeleton; S^ with its coarser levels, a factor and
  // a block of either on the contacts.
  constexpr double bytes_per_node_and_level = 60, bytes_per_node = 200;
  constexpr double trace_blocks = 3, skeleton_blocks = 2, contact_blocks = 3.5, fixed = 1 << 14;
  const ddm::Sides sides = ddm::find_sides(mesh);
  double bytes = fixed;
  for (const Size& size : subdomain_sizes(mesh, sides)) {
    bytes += size.nodes * (bytes_per_node + bytes_per_node_and_level * std::log2(size.nodes + 1));
    bytes += trace_blocks * sizeof(double) * size.trace * size.trace;
  }
  const SkeletonSize size = skeleton_size(mesh, sides);
  bytes += skeleton_blocks * sizeof(double) * size.unknowns * size.unknowns;
  bytes += contact_blocks * sizeof(double) * size.contacts * size.contacts;
  return static_cast<std::size_t>(bytes);
}

}  // namespace anticrack::operators
