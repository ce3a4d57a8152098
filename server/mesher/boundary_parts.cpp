// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>
#include <unordered_map>

#include "mesher/import_steps.hpp"
#include "mesher/messages.hpp"

namespace anticrack::mesher {
namespace {

/// As many as a geometry may have sides.
constexpr std::size_t max_names = 1'000;

/// Nodes in which more than one edge of the boundary begins.
std::vector<bool> touching(const mesh::EdgeTable& edges, std::size_t node_count) {
  std::vector<bool> begun(node_count), touching(node_count);
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    if (uses.size() != 1) return;
    const std::size_t from = at(uses[0].from);
    if (begun[from]) touching[from] = true;
    begun[from] = true;
  });
  return touching;
}

}  // namespace

std::vector<mesh::BoundaryPart> boundary_parts(std::span<const BoundaryEdge> named,
                                               const mesh::EdgeTable& edges, mesh::Mesh& mesh) {
  if (named.empty()) return {};
  const std::vector<bool> touch = touching(edges, mesh.node_count());
  std::unordered_map<std::int32_t, std::size_t> from, to;  // edges by their nodes
  std::set<std::string> names, lost;
  for (std::size_t e = 0; e < named.size(); ++e) {
    from[named[e].from] = to[named[e].to] = e;
    if (names.size() <= max_names) names.insert(named[e].part);
  }
  if (names.size() > max_names) {
    mesh.warnings.push_back(
        fmt::format("groups give the boundary more than {} names: answers have its forces as one; "
                    "put its curves in fewer groups",
                    max_names));
    return {};
  }
  // the edge of this name in a node, or the number of all
  const auto on = [&](const std::unordered_map<std::int32_t, std::size_t>& of, std::int32_t node,
                      const std::string& name) {
    const auto found = touch[at(node)] ? of.end() : of.find(node);
    return found != of.end() && named[found->second].part == name ? found->second : named.size();
  };
  std::vector<mesh::BoundaryPart> parts;
  std::vector<bool> done(named.size());
  const auto walk = [&](std::size_t e) {
    mesh::BoundaryPart part{named[e].part, named[e].from, named[e].to};
    for (std::size_t k = e; k < named.size() && !done[k]; k = on(from, part.last, part.name)) {
      done[k] = true;
      part.last = named[k].to;
    }
    if (touch[at(part.first)])
      lost.insert(part.name);
    else
      parts.push_back(std::move(part));
  };
  for (std::size_t e = 0; e < named.size(); ++e)
    if (on(to, named[e].from, named[e].part) == named.size()) walk(e);
  for (std::size_t e = 0; e < named.size(); ++e)
    if (!done[e]) walk(e);  // a whole ring
  if (!lost.empty())
    mesh.warnings.push_back(fmt::format(
        "the boundary touches itself in a node: what begins there of {} counts as \"boundary\" in "
        "answers",
        list_of(lost, "\"")));
  return parts;
}

}  // namespace anticrack::mesher
