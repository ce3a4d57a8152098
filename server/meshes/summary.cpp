// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "base/union_find.hpp"
#include "mesh/edges.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/joined_inclusions.hpp"
#include "mesh/quality.hpp"
#include "mesh/refine.hpp"
#include "meshes/tension_laws.hpp"
#include "stop/stop.hpp"

namespace anticrack::meshes {

namespace {

using EdgeKey = std::pair<std::int32_t, std::int32_t>;

constexpr const char* measuring = "measuring a mesh";

EdgeKey key(std::int32_t a, std::int32_t b) noexcept { return std::minmax(a, b); }

double length(const mesh::Mesh& mesh, std::int32_t a, std::int32_t b) noexcept {
  return mesh::distance(mesh::position(mesh, a), mesh::position(mesh, b));
}

/// The lengths of the shortest and the longest edge.
std::pair<double, double> edge_lengths(const mesh::Mesh& mesh, std::size_t triangle) noexcept {
  const std::int32_t* node = &mesh.triangles[3 * triangle];
  return std::minmax({length(mesh, node[0], node[1]), length(mesh, node[1], node[2]),
                      length(mesh, node[2], node[0])});
}

void measure_triangles(const mesh::Mesh& mesh, std::vector<records::SubdomainSummary>& result) {
  std::vector<mesh::Angle> least(result.size());
  for (records::SubdomainSummary& to : result)
    to.shortest_edge = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    stop::look_at_turn(t, measuring);
    const std::size_t s = at(mesh.subdomain[t]);
    records::SubdomainSummary& to = result[s];
    ++to.triangle_count;
    to.area += mesh::area(mesh, t);
    least[s] =
        std::min(least[s], mesh::least_angle(mesh::corner(mesh, t, 0), mesh::corner(mesh, t, 1),
                                             mesh::corner(mesh, t, 2)));
    const auto [shortest, longest] = edge_lengths(mesh, t);
    to.shortest_edge = std::min(to.shortest_edge, shortest);
    to.longest_edge = std::max(to.longest_edge, longest);
  }
  for (std::size_t s = 0; s < result.size(); ++s) result[s].minimum_angle = least[s].degrees();
}

void count_nodes(const mesh::Mesh& mesh, std::vector<records::SubdomainSummary>& result) {
  std::vector<std::vector<std::size_t>> triangles(result.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    triangles[at(mesh.subdomain[t])].push_back(t);
  constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> last_seen_in(mesh.node_count(), nowhere);
  for (std::size_t i = 0; i < result.size(); ++i) {
    stop::look(measuring);
    for (const std::size_t t : triangles[i]) {
      for (std::size_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
        std::size_t& last = last_seen_in[at(mesh.triangles[corner])];
        result[i].node_count += last != i ? 1 : 0;
        last = i;
      }
    }
  }
}

/// Which subdomains have a part that floats. A part consists of triangles connected without
/// crossing an interface; it floats if none of its nodes is a Dirichlet node.
std::vector<bool> floating_subdomains(const mesh::Mesh& mesh, const mesh::EdgeTable& edges) {
  std::vector<EdgeKey> cuts;
  std::vector<bool> on_interface(mesh.node_count(), false);  // few edges lie between two of these
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (const std::int32_t node : interface.nodes) on_interface[at(node)] = true;
    for (std::size_t i = 0; i + 1 < interface.nodes.size(); ++i)
      cuts.push_back(key(interface.nodes[i], interface.nodes[i + 1]));
  }
  std::sort(cuts.begin(), cuts.end());
  base::UnionFind parts(mesh.triangle_count());
  std::size_t turn = 0;
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    stop::look_at_turn<stop::quick>(turn++, measuring);
    const EdgeKey edge{uses[0].low(), uses[0].high()};
    const bool may_be_cut = on_interface[at(edge.first)] && on_interface[at(edge.second)];
    if (uses.size() != 2 || (may_be_cut && std::binary_search(cuts.begin(), cuts.end(), edge)))
      return;
    parts.unite(uses[0].triangle, uses[1].triangle);
  });
  std::vector<bool> fixed(mesh.node_count(), false);
  for (const auto& [a, b] : mesh.dirichlet) {
    fixed[at(a)] = true;
    fixed[at(b)] = true;
  }
  std::vector<bool> held(mesh.triangle_count(), false);
  const auto part_of = [&](std::size_t triangle) {
    return at(parts.find(static_cast<std::int32_t>(triangle)));
  };
  for (std::size_t corner = 0; corner < mesh.triangles.size(); ++corner)
    if (fixed[at(mesh.triangles[corner])]) held[part_of(corner / 3)] = true;
  std::vector<bool> floating(mesh.subdomains.size(), false);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (!held[part_of(t)]) floating[at(mesh.subdomain[t])] = true;
  return floating;
}

std::vector<records::TipSummary> tip_summaries(const mesh::Mesh& mesh,
                                               const mesh::EdgeTable& edges) {
  const std::vector<std::int32_t> nodes = mesh::tips(mesh, edges, mesh::edge_ends(mesh, edges));
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> tip_at(mesh.node_count(), none);
  std::vector<records::TipSummary> result;
  result.reserve(nodes.size());
  for (const std::int32_t node : nodes) {
    const auto n = at(node);
    tip_at[n] = result.size();
    result.push_back(
        {{mesh.xy[2 * n], mesh.xy[2 * n + 1]}, "", std::numeric_limits<double>::infinity()});
  }
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (const std::int32_t node : interface.nodes) {
      const std::size_t tip = tip_at[at(node)];
      if (tip != none && result[tip].interface.empty()) result[tip].interface = interface.name;
    }
  }
  for (std::size_t corner = 0; corner < mesh.triangles.size(); ++corner) {
    const std::size_t tip = tip_at[at(mesh.triangles[corner])];
    if (tip == none) continue;
    double& smallest = result[tip].smallest_edge;
    smallest = std::min(smallest, edge_lengths(mesh, corner / 3).first);
  }
  return result;
}

void measure_boundary(const mesh::Mesh& mesh, const mesh::EdgeTable& edges,
                      records::MeshRecord& record) {
  std::vector<EdgeKey> fixed;
  fixed.reserve(mesh.dirichlet.size());
  for (const auto& [a, b] : mesh.dirichlet) fixed.push_back(key(a, b));
  std::sort(fixed.begin(), fixed.end());
  record.dirichlet_length = 0;
  record.neumann_length = 0;
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    if (uses.size() != 1) return;
    const EdgeKey edge{uses[0].low(), uses[0].high()};
    const bool dirichlet = std::binary_search(fixed.begin(), fixed.end(), edge);
    (dirichlet ? record.dirichlet_length : record.neumann_length) +=
        length(mesh, edge.first, edge.second);
  });
}

records::InterfaceSummary summary(const mesh::Mesh& mesh, const mesh::Interface& interface) {
  const std::vector<double> s = mesh::arc_length(mesh, interface);
  const std::size_t first = 2 * at(interface.nodes.front());
  records::InterfaceSummary result{
      interface.name, s.back(), s.size(), {}, {{mesh.xy[first], mesh.xy[first + 1]}}};
  for (std::size_t e = 0; e < interface.kind.size(); ++e) {
    if (e == 0 || interface.kind[e] != interface.kind[e - 1] ||
        interface.inclusion[e] != interface.inclusion[e - 1])
      result.segments.push_back({interface.kind[e], interface.inclusion[e], s[e], s[e], 0});
    records::SegmentSummary& segment = result.segments.back();
    segment.end = s[e + 1];
    ++segment.edge_count;
  }
  return result;
}

void note_tilts(const mesh::Mesh& mesh, std::vector<std::string>& warnings) {
  constexpr std::size_t most = 20;
  std::size_t count = 0;
  for (std::string& why : mesh::why_none_tilts(mesh))
    if (!why.empty() && ++count <= most) warnings.push_back(std::move(why));
  if (count > most) warnings.push_back(fmt::format("and {} more such inclusions", count - most));
}

}  // namespace

void summarize(const mesh::Mesh& mesh, records::MeshRecord& record) {
  record.node_count = mesh.node_count();
  record.triangle_count = mesh.triangle_count();
  record.subdomains.assign(mesh.subdomains.size(), {});
  std::vector<bool> floating(mesh.subdomains.size(), false);
  const auto by_triangles = [&] {
    measure_triangles(mesh, record.subdomains);
    count_nodes(mesh, record.subdomains);
  };
  const auto by_edges = [&] {
    const mesh::EdgeTable edges(mesh.triangles);
    floating = floating_subdomains(mesh, edges);
    record.tips = tip_summaries(mesh, edges);
    measure_boundary(mesh, edges, record);
  };
  base::at_once(2, 2,
                [&] { return [&](std::size_t part) { part == 0 ? by_triangles() : by_edges(); }; });
  for (std::size_t i = 0; i < floating.size(); ++i) {
    record.subdomains[i].name = mesh.subdomains[i];
    record.subdomains[i].floating = floating[i];
  }
  summarize_tension(mesh, record);
  record.interfaces.clear();
  for (const mesh::Interface& interface : mesh.interfaces)
    record.interfaces.push_back(summary(mesh, interface));
  record.inclusions = mesh.inclusions;
  record.warnings = mesh.warnings;
  note_tilts(mesh, record.warnings);
  record.minimum_angle =
      std::ranges::min(record.subdomains, {}, &records::SubdomainSummary::minimum_angle)
          .minimum_angle;
  record.bisection_bound = mesh.bisection_bound;
}

records::Block mesh_block(const mesh::Mesh& mesh) {
  records::BlockBuilder builder;
  builder.add("nodes", mesh.xy, {mesh.node_count(), 2});
  builder.add("triangles", mesh.triangles, {mesh.triangle_count(), 3});
  builder.add("subdomain", mesh.subdomain);
  std::vector<std::int32_t> boundary;
  boundary.reserve(2 * mesh.dirichlet.size());
  for (const auto& edge : mesh.dirichlet) boundary.insert(boundary.end(), edge.begin(), edge.end());
  builder.add("boundary", boundary, {mesh.dirichlet.size(), 2});
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const mesh::Interface& interface = mesh.interfaces[i];
    const std::string path = fmt::format("interfaces/{}/", i);
    builder.add(path + "nodes", interface.nodes);
    builder.add(path + "edge_kind", interface.kind);
    builder.add(path + "edge_inclusion", interface.inclusion);
  }
  return builder.finish();
}

}  // namespace anticrack::meshes
