// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/mesh_plan.hpp"

#include <cmath>

#include "results/block.hpp"

namespace anticrack::results {
namespace {

InterfaceLine line_of(const Block& block, const std::string& name) {
  const std::string at = "interfaces/" + name;
  InterfaceLine line;
  line.name = name;
  line.nodes = block.get<std::int32_t>(at + "/nodes");
  line.inclusion = block.get<std::int32_t>(at + "/inclusion");
  const auto kinds = block.get<std::int32_t>(at + "/kind");
  line.kind.reserve(kinds.size());
  for (const std::int32_t kind : kinds) line.kind.push_back(static_cast<Kind>(kind));
  return line;
}

std::string fault_of(const InterfaceLine& line, const MeshPlan& plan) {
  const std::string at = "interface \"" + line.name + "\"";
  const std::size_t edges = line.kind.size();
  if (line.nodes.size() != edges + 1 || line.inclusion.size() != edges) {
    return at + " has " + std::to_string(line.nodes.size()) + " nodes for " +
           std::to_string(edges) + " edges";
  }
  for (const std::int32_t node : line.nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= plan.mesh.node_count()) {
      return at + " has the node " + std::to_string(node) + " outside the mesh";
    }
  }
  for (std::size_t e = 0; e < edges; ++e) {
    const auto kind = static_cast<std::int32_t>(line.kind[e]);
    if (kind < 1 || kind > 4) return at + " has the unknown kind " + std::to_string(kind);
    if (line.inclusion[e] < -1 ||
        line.inclusion[e] >= static_cast<std::int32_t>(plan.inclusions.size())) {
      return at + " has the inclusion " + std::to_string(line.inclusion[e]) + ", which is none";
    }
  }
  return "";
}

}  // namespace

std::string first_fault(const MeshPlan& plan) {
  std::string fault = first_mesh_fault(plan.mesh);
  for (const InterfaceLine& line : plan.interfaces) {
    if (fault.empty()) fault = fault_of(line, plan);
  }
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
  for (InterfaceLine& line : messages.interfaces) line = line_of(block, line.name);
  const std::string fault = first_fault(messages);
  if (!fault.empty()) block.fail(fault);
  return messages;
}

}  // namespace anticrack::results
