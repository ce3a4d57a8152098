// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/summary.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace anticrack::meshes {

namespace {

std::vector<store::SubdomainSummary> subdomains(const mesh::Mesh& mesh) {
  std::vector<store::SubdomainSummary> result(mesh.subdomains.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].name = mesh.subdomains[i];
  }
  std::vector<std::vector<std::size_t>> triangles(result.size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto i = static_cast<std::size_t>(mesh.subdomain[t]);
    triangles[i].push_back(t);
    result[i].area += mesh::area(mesh, t);
  }
  constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> last_seen_in(mesh.node_count(), nowhere);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].triangle_count = triangles[i].size();
    for (const std::size_t t : triangles[i]) {
      for (std::size_t corner = 3 * t; corner < 3 * t + 3; ++corner) {
        std::size_t& last = last_seen_in[static_cast<std::size_t>(mesh.triangles[corner])];
        result[i].node_count += last != i ? 1 : 0;
        last = i;
      }
    }
  }
  return result;
}

store::InterfaceSummary summary(const mesh::Mesh& mesh, const mesh::Interface& interface) {
  const std::vector<double> s = mesh::arc_length(mesh, interface);
  store::InterfaceSummary result{interface.name, s.back(), s.size(), {}};
  for (std::size_t e = 0; e < interface.kind.size(); ++e) {
    if (e == 0 || interface.kind[e] != interface.kind[e - 1] ||
        interface.inclusion[e] != interface.inclusion[e - 1]) {
      result.segments.push_back({interface.kind[e], interface.inclusion[e], s[e], s[e], 0});
    }
    store::SegmentSummary& segment = result.segments.back();
    segment.end = s[e + 1];
    ++segment.edge_count;
  }
  return result;
}

}  // namespace

void summarize(const mesh::Mesh& mesh, store::MeshRecord& record) {
  record.node_count = mesh.node_count();
  record.triangle_count = mesh.triangle_count();
  record.subdomains = subdomains(mesh);
  record.interfaces.clear();
  for (const mesh::Interface& interface : mesh.interfaces) {
    record.interfaces.push_back(summary(mesh, interface));
  }
  record.inclusions = mesh.inclusions;
  record.warnings = mesh.warnings;
  record.minimum_angle = mesh::minimum_angle(mesh);
}

store::Block mesh_block(const mesh::Mesh& mesh) {
  store::BlockBuilder builder;
  builder.add("nodes", mesh.xy, {mesh.node_count(), 2});
  builder.add("triangles", mesh.triangles, {mesh.triangle_count(), 3});
  builder.add("subdomain", mesh.subdomain);
  std::vector<std::int32_t> boundary;
  boundary.reserve(2 * mesh.dirichlet.size());
  for (const auto& edge : mesh.dirichlet) {
    boundary.insert(boundary.end(), edge.begin(), edge.end());
  }
  builder.add("boundary", boundary, {mesh.dirichlet.size(), 2});
  for (const mesh::Interface& interface : mesh.interfaces) {
    const std::string path = "interfaces/" + interface.name + "/";
    std::vector<std::int32_t> kinds;
    kinds.reserve(interface.kind.size());
    for (const mesh::Kind kind : interface.kind) {
      kinds.push_back(static_cast<std::int32_t>(kind));
    }
    builder.add(path + "nodes", interface.nodes);
    builder.add(path + "kind", kinds);
    builder.add(path + "inclusion", interface.inclusion);
  }
  return builder.finish();
}

}  // namespace anticrack::meshes
