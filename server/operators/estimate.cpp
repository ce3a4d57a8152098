// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/at.hpp"
#include "contact/joined_problem.hpp"
#include "ddm/cut_steps.hpp"
#include "operators/mesh_operator.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

struct Size {
  double nodes = 0;
  double trace = 0;
};

/// The nodes of each subdomain, and how many of them lie on interfaces; each side counts once.
std::vector<Size> subdomain_sizes(const mesh::Mesh& mesh, const ddm::Sides& sides) {
  std::vector<Size> sizes(mesh.subdomains.size());
  std::vector<char> seen(mesh.node_count(), 0);
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    stop::look_at_turn<stop::quick>(c, "estimating the memory of a mesh");
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

/// Upper bounds of the number of unknowns and contacts of the skeleton.
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

/// Contacts of an interface, at most.
double contacts_of(const mesh::Interface& interface) {
  return static_cast<double>(std::ranges::count(interface.kind, mesh::Kind::crack) +
                             std::ranges::count(interface.kind, mesh::Kind::delaminated) + 1);
}

/// Upper bound of the memory of a joined membrane's contacts: a dense matrix with its coarser
/// levels, two factors and a block of each; or blocks, each with as many contacts as its interface
/// has or a block may have.
double joined_bytes(const mesh::Mesh& mesh, double contacts) {
  constexpr double dense_matrices = 4.5, block_matrices = 2.5, most = contact::most_of_a_block;
  double blocks = 0;
  bool long_cracks = false;
  for (const mesh::Interface& interface : mesh.interfaces) {
    const double own = contacts_of(interface);
    long_cracks = long_cracks || own > most;
    blocks += block_matrices * sizeof(double) * own * std::min(own, most);
  }
  const bool dense = contacts <= static_cast<double>(contact::dense_contacts(long_cracks));
  return dense ? std::max(blocks, dense_matrices * sizeof(double) * contacts * contacts) : blocks;
}

}  // namespace

std::size_t estimate_bytes(const mesh::Mesh& mesh) {
  // The factor of a planar graph ordered by nested dissection has O(n log n) entries; measured with
  // all other data per node: 30 to 42 bytes times log2(n) a node, from 1 k to 2 M nodes. Dense
  // matrices: S and the flexibility on the trace; H and W on the skeleton; S^ with its coarser
  // levels, two factors and a block of each on the contacts. A joined membrane has the stiffness
  // three times.
  constexpr double bytes_per_node_and_level = 60, bytes_per_node = 200, bytes_per_joined_node = 500;
  constexpr double trace_blocks = 3, skeleton_blocks = 2, contact_blocks = 4.5, fixed = 1 << 14,
                   bytes_per_law = sizeof(fem::Tension::of_triangle[0]) + sizeof(fem::Variation),
                   bytes_near_tips = 60;  // a triangle; most lie in the discs of one or two tips
  const ddm::Sides sides = ddm::find_sides(mesh);
  const std::vector<Size> sizes = subdomain_sizes(mesh, sides);
  const SkeletonSize skeleton = skeleton_size(mesh, sides);
  constexpr auto most = static_cast<double>(default_condensed_up_to);
  const bool joined = skeleton.unknowns > most || std::ranges::any_of(sizes, [](const Size& size) {
                        return size.trace > most;
                      });
  double bytes = fixed, nodes = 0;
  for (const Size& size : sizes) {
    nodes += size.nodes;
    if (joined) continue;
    bytes += size.nodes * (bytes_per_node + bytes_per_node_and_level * std::log2(size.nodes + 1));
    bytes += trace_blocks * sizeof(double) * size.trace * size.trace;
  }
  if (joined) {
    bytes += nodes * (bytes_per_joined_node + bytes_per_node_and_level * std::log2(nodes + 1));
    bytes += joined_bytes(mesh, skeleton.contacts);
  } else {
    bytes += skeleton_blocks * sizeof(double) * skeleton.unknowns * skeleton.unknowns;
    bytes += contact_blocks * sizeof(double) * skeleton.contacts * skeleton.contacts;
  }
  if (!mesh.tension_laws.empty())
    bytes += bytes_per_law * static_cast<double>(mesh.triangle_count());
  if (!mesh.interfaces.empty())
    bytes += bytes_near_tips * static_cast<double>(mesh.triangle_count());
  return static_cast<std::size_t>(bytes);
}

}  // namespace anticrack::operators
