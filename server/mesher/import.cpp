// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "mesher/import_steps.hpp"
#include "mesher/messages.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

using mesh::Kind;
using mesh::Mesh;

constexpr std::size_t max_warnings = 100;

/// The mesh after welding, without subdomains and interfaces.
Mesh welded_mesh(const PlaneMesh& plane, const Welding& welding) {
  Mesh mesh;
  mesh.warnings = plane.warnings;
  mesh.xy.reserve(2 * welding.node_count);
  for (std::size_t i = 0; i < welding.node.size(); ++i) {
    if (at(welding.node[i]) < mesh.node_count()) continue;
    mesh.xy.push_back(plane.xy[2 * i]);
    mesh.xy.push_back(plane.xy[2 * i + 1]);
  }
  mesh.triangles.reserve(plane.triangles.size());
  for (const std::int32_t node : plane.triangles) mesh.triangles.push_back(welding.node[at(node)]);
  const std::size_t doubles = welding.node.size() - welding.node_count;
  if (doubles > 0) {
    mesh.warnings.push_back(
        fmt::format("{} on another made one with it, as are {} pairs of edges: cracks are opened "
                    "again by the solver",
                    doubles == 1 ? "1 node that lies" : fmt::format("{} nodes that lie", doubles),
                    welding.doubled.size()));
  }
  return mesh;
}

std::array<std::int32_t, 3> sorted_nodes(const PlaneMesh& plane, std::int32_t triangle) {
  const auto i = 3 * at(triangle);
  std::array<std::int32_t, 3> nodes{plane.triangles[i], plane.triangles[i + 1],
                                    plane.triangles[i + 2]};
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

[[noreturn]] void refuse_overlap(const MshFile& file, const PlaneMesh& plane,
                                 const mesh::EdgeUse& a, const mesh::EdgeUse& b) {
  const auto& first = file.triangles[at(a.triangle)];
  const auto& second = file.triangles[at(b.triangle)];
  const auto tag = [&](std::int32_t node) { return plane.tags[at(node)]; };
  const std::string edge = fmt::format("the edge of nodes {} and {}", tag(a.from), tag(a.to));
  if (sorted_nodes(plane, a.triangle) != sorted_nodes(plane, b.triangle)) {
    refuse("triangles {} and {} overlap at {}; mesh every surface once", first.tag, second.tag,
           edge);
  }
  if (first.group != second.group) {
    refuse(
        "a triangle at {} is in the physical surfaces {} and {}; a surface belongs to one "
        "subdomain, so put it in one group",
        edge, first.group, second.group);
  }
  refuse("triangles {} and {} are the same, at {}; mesh every surface once", first.tag, second.tag,
         edge);
}

/// Refuses two triangles on the same side of an edge.
void check_sides(const MshFile& file, const PlaneMesh& plane) {
  mesh::EdgeTable(plane.triangles).each([&](std::span<const mesh::EdgeUse> uses) {
    for (std::size_t i = 1; i < uses.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        if (uses[i].from == uses[j].from) refuse_overlap(file, plane, uses[j], uses[i]);
    }
  });
}

/// Lines between nodes of triangles. Other lines are left out, or refused if they have a meaning.
std::vector<CurveEdge> take_lines(const MshFile& file, const PlaneMesh& plane,
                                  const Welding& welding, const CurveGroups& groups, Mesh& mesh) {
  std::vector<CurveEdge> lines;
  lines.reserve(file.lines.size());
  std::map<std::int32_t, std::size_t> stray;
  for (const auto& line : file.lines) {
    const CurveGroup* group = groups.of(line);
    const auto a = plane.of.find(line.nodes[0]);
    const auto b = plane.of.find(line.nodes[1]);
    if (a != plane.of.end() && b != plane.of.end() && a->second >= 0 && b->second >= 0) {
      lines.push_back({welding.node[at(a->second)], welding.node[at(b->second)], group});
    } else if (group != nullptr && group->meaning) {
      refuse(
          "line {} of {} has a node that belongs to no triangle; mesh surfaces and curves together",
          line.tag, group->title);
    } else if (group != nullptr) {
      ++stray[group->tag];
    }
  }
  for (const auto& [tag, count] : stray) {
    mesh.warnings.push_back(
        fmt::format("{} has {} line{} with nodes that belong to no triangle: left out",
                    groups.groups.at(tag).title, count, count == 1 ? "" : "s"));
  }
  return lines;
}

/// Warns of empty groups: an inclusion with a name but no lines would be missing without a word.
void note_empty_groups(const MshFile& file, const CurveGroups& groups, Mesh& mesh) {
  std::set<const CurveGroup*> met;
  for (const auto& line : file.lines) met.insert(groups.of(line));
  for (const auto& [tag, group] : groups.groups) {
    if (!group.meaning || met.contains(&group)) continue;
    mesh.warnings.push_back(fmt::format(
        "{} has no line in the file: left out; save its curve with the surfaces", group.title));
  }
}

/// Edges at which lines and doubled nodes may divide a surface.
std::vector<std::pair<std::int32_t, std::int32_t>> cuts_of(const std::vector<CurveEdge>& lines,
                                                           const Welding& welding) {
  std::vector<std::pair<std::int32_t, std::int32_t>> cuts;
  cuts.reserve(lines.size() + welding.doubled.size());
  for (const CurveEdge& line : lines) cuts.push_back(std::minmax(line.from, line.to));
  for (const DoubledEdge& edge : welding.doubled) cuts.emplace_back(edge.low, edge.high);
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

Kind kind_of(CurveRole role) {
  if (role == CurveRole::crack) return Kind::crack;
  if (role == CurveRole::free) return Kind::free;
  if (role == CurveRole::inclusion) return Kind::inclusion;
  return role == CurveRole::delaminated ? Kind::delaminated : Kind::glue;
}

void take_interfaces(const EdgeRoles& roles, const std::vector<bool>& on_boundary,
                     const DirectedLines& lines, Mesh& mesh) {
  std::vector<Chain> chains = build_chains(roles.interfaces, on_boundary);
  const bool single = chains.size() == 1;
  std::map<std::string, std::int32_t> inclusions;  // numbers, in the order met
  const auto inclusion_of = [&](const CurveMeaning& meaning) -> std::int32_t {
    if (!is_rigid(meaning.role)) return -1;
    const auto next = static_cast<std::int32_t>(inclusions.size());
    const auto [entry, added] = inclusions.emplace(meaning.name, next);
    if (added) mesh.inclusions.push_back(meaning.name);
    return entry->second;
  };
  mesh.interfaces.reserve(chains.size());
  for (Chain& found : chains) {
    Oriented oriented = orient(std::move(found), mesh, lines);
    mesh::Interface interface;
    interface.name = single ? "interface" : fmt::format("interface-{}", mesh.interfaces.size() + 1);
    interface.nodes = std::move(oriented.chain.nodes);
    interface.kind.reserve(oriented.chain.edges.size());
    interface.inclusion.reserve(oriented.chain.edges.size());
    for (const InterfaceEdge* edge : oriented.chain.edges) {
      interface.kind.push_back(kind_of(edge->meaning.role));
      interface.inclusion.push_back(inclusion_of(edge->meaning));
    }
    if (!oriented.note.empty()) mesh.warnings.push_back(interface.name + ": " + oriented.note);
    mesh.interfaces.push_back(std::move(interface));
  }
}

/// As check_contacts in mesh/geometry.cpp: no piece of the membrane may be held in one point alone.
void check_contacts(const mesh::EdgeTable& edges, const Mesh& mesh) {
  struct Ends {
    int held = 0;
    int boundary = 0;
    int parts = 0;
  };
  std::map<std::int32_t, Ends> ends;
  for (const auto& edge : mesh.dirichlet)
    for (const std::int32_t node : edge) ++ends[node].held;
  const auto add = [&](std::int32_t node, int Ends::*count) {
    if (const auto found = ends.find(node); found != ends.end()) ++(found->second.*count);
  };
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    if (uses.size() != 1) return;
    add(uses[0].from, &Ends::boundary);
    add(uses[0].to, &Ends::boundary);
  });
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (std::size_t i = 0; i < interface.kind.size(); ++i) {
      if (interface.kind[i] == Kind::glue) continue;
      add(interface.nodes[i], &Ends::parts);
      add(interface.nodes[i + 1], &Ends::parts);
    }
  }
  for (const auto& [node, there] : ends) {
    const bool both_sides = there.held == there.boundary;
    if (there.parts == 0 || (both_sides && there.parts == 1)) continue;
    refuse("{} at {} on the boundary, where u is held{}",
           both_sides ? "two inclusions or cracks end" : "an inclusion or a crack ends",
           place_of(mesh, node),
           both_sides ? "; let them end apart"
                      : " on one side of it only; end it elsewhere, or name both sides alike");
  }
}

void take_motions(const std::map<std::string, mesh::Motion>& given, Mesh& mesh) {
  if (given.empty()) return;
  mesh.motions.resize(mesh.inclusions.size());
  for (const auto& [name, motion] : given) {
    const auto found = std::find(mesh.inclusions.begin(), mesh.inclusions.end(), name);
    if (found == mesh.inclusions.end()) {
      throw errors::Error(
          errors::Reason::invalid_argument, "\"{}\" is not an inclusion of the file; {}",
          printable(name),
          mesh.inclusions.empty() ? "it has none" : "they are " + list_of(mesh.inclusions, "\""))
          .at(fmt::format("options.inclusion_motions[{}]", printable(name)));
    }
    mesh.motions[at(found - mesh.inclusions.begin())] = motion;
  }
}

void shorten(std::vector<std::string>& warnings) {
  if (warnings.size() <= max_warnings) return;
  const std::size_t more = warnings.size() - max_warnings;
  warnings.resize(max_warnings);
  warnings.push_back(fmt::format("and {} more", more));
}

}  // namespace

Mesh to_mesh(const MshFile& file, const mesh::MeshOptions& options) {
  const PlaneMesh plane = read_plane(file);
  const CurveGroups groups = read_curve_groups(file, options.curve_groups);
  check_sides(file, plane);
  const Welding welding = weld(plane.xy, plane.triangles, plane.tags);
  Mesh mesh = welded_mesh(plane, welding);
  const std::vector<CurveEdge> lines = take_lines(file, plane, welding, groups, mesh);
  note_empty_groups(file, groups, mesh);
  const mesh::EdgeTable edges(mesh.triangles);
  read_surfaces(file, options, edges, cuts_of(lines, welding), mesh);
  EdgeRoles roles = read_edges(edges, lines, groups, welding, mesh);
  DirectedLines directed;
  for (const CurveEdge& line : lines) directed.insert({line.from, line.to});
  take_interfaces(roles, edges.boundary_nodes(mesh.node_count()), directed, mesh);
  take_motions(options.inclusion_motions, mesh);
  mesh.dirichlet = std::move(roles.dirichlet);
  mesh.boundary_parts = boundary_parts(roles.named, edges, mesh);
  check_contacts(edges, mesh);
  shorten(mesh.warnings);
  mesh::validate(mesh);
  return mesh;
}

Mesh import_msh(std::string_view bytes, const mesh::MeshOptions& options,
                std::size_t max_triangles) {
  return to_mesh(read_mesh_file(bytes, max_triangles), options);
}

}  // namespace anticrack::mesher
