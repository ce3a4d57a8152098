// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "operators/mesh_operator.hpp"

namespace anticrack::operators {
namespace {

struct Size {
  double nodes = 0;
  double trace = 0;
};

/// Nodes of each subdomain, and those of them on interfaces.
std::vector<Size> subdomain_sizes(const mesh::Mesh& mesh) {
  std::vector<char> on_interface(mesh.node_count(), 0), seen(mesh.node_count(), 0);
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (const std::int32_t node : interface.nodes) {
      on_interface[static_cast<std::size_t>(node)] = 1;
    }
  }
  std::vector<Size> sizes(mesh.subdomains.size());
  std::set<std::pair<std::int32_t, std::int32_t>> traces;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto node = static_cast<std::size_t>(mesh.triangles[i]);
    const std::int32_t subdomain = mesh.subdomain[i / 3];
    if (on_interface[node] != 0) {
      traces.emplace(subdomain, mesh.triangles[i]);
    } else if (seen[node] == 0) {
      seen[node] = 1;
      sizes[static_cast<std::size_t>(subdomain)].nodes += 1;
    }
  }
  for (const auto& [subdomain, node] : traces) {
    sizes[static_cast<std::size_t>(subdomain)].nodes += 1;
    sizes[static_cast<std::size_t>(subdomain)].trace += 1;
  }
  return sizes;
}

}  // namespace

std::size_t estimate_bytes(const mesh::Mesh& mesh) {
  // The sparse factor of a planar graph in a minimum degree order has O(n log n) entries. Measured
  // with everything else that is kept per node: 35 to 42 bytes a node and log2(n) from 1 k to 2 M
  // nodes, structured and unstructured. Dense on the trace: L_GG twice (in the factor and out of
  // it) and the flexibility.
  constexpr double bytes_per_node_and_level = 60, bytes_per_node = 200;
  constexpr double dense_blocks = 3, fixed = 1 << 14;
  double bytes = fixed;
  for (const Size& size : subdomain_sizes(mesh)) {
    bytes += size.nodes * (bytes_per_node + bytes_per_node_and_level * std::log2(size.nodes + 1));
    bytes += dense_blocks * sizeof(double) * size.trace * size.trace;
  }
  return static_cast<std::size_t>(bytes);
}

}  // namespace anticrack::operators
