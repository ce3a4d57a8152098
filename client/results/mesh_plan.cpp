// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/mesh_plan.hpp"

#include <cmath>

#include "results/block.hpp"

namespace anticrack::results {
namespace {

std::string fault_of(const std::string& at, const InterfaceLine& line, const Mesh& mesh) {
  for (const std::int32_t node : line.nodes)
    if (node < 0 || static_cast<std::size_t>(node) >= mesh.node_count())
      return at + " has the node " + std::to_string(node) + " outside the mesh";
  return first_edge_fault(at, line.edges, line.nodes.size(), mesh);
}

}  // namespace

std::string first_fault(const MeshPlan& plan) {
  std::string fault = first_mesh_fault(plan.mesh);
  for (std::size_t i = 0; i < plan.interfaces.size() && fault.empty(); ++i)
    fault = fault_of("interfaces[" + std::to_string(i) + "]", plan.interfaces[i], plan.mesh);
  for (const Tip& tip : plan.tips) {
    const bool finite =
        std::isfinite(tip.x) && std::isfinite(tip.y) && std::isfinite(tip.smallest_edge);
    if (fault.empty() && !finite) fault = "a tip is not finite";
  }
  return fault;
}

MeshPlan assemble_mesh(MeshPlan messages, std::span<const ArrayView> mesh_block) {
  const Block block("the mesh read from the server", mesh_block);
  add_mesh(block, messages.mesh);
  for (std::size_t i = 0; i < messages.interfaces.size(); ++i) {
    InterfaceLine& line = messages.interfaces[i];
    line.nodes = block.get<std::int32_t>(arrays::interface_folder(i) + "nodes");
    line.edges = edges_of(block, i);
  }
  block.require(first_fault(messages));
  return messages;
}

}  // namespace anticrack::results
