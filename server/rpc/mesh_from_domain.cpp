// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>

#include "rpc/error_table.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/names.hpp"

namespace anticrack::rpc {
namespace {

v1::Mesh::State from_state(store::MeshState state) {
  switch (state) {
    case store::MeshState::pending:
      return v1::Mesh::STATE_PENDING;
    case store::MeshState::meshing:
      return v1::Mesh::STATE_MESHING;
    case store::MeshState::factorizing:
      return v1::Mesh::STATE_FACTORIZING;
    case store::MeshState::ready:
      return v1::Mesh::STATE_READY;
    case store::MeshState::evicted:
      return v1::Mesh::STATE_EVICTED;
    case store::MeshState::failed:
      return v1::Mesh::STATE_FAILED;
  }
  return v1::Mesh::STATE_UNSPECIFIED;
}

v1::InterfaceKind from_kind(mesh::Kind kind) {
  return static_cast<v1::InterfaceKind>(static_cast<std::int32_t>(kind));
}

v1::InterfaceInfo from_interface(const store::InterfaceSummary& summary) {
  v1::InterfaceInfo info;
  info.set_name(summary.name);
  info.set_length(summary.length);
  info.set_node_count(summary.node_count);
  for (const store::SegmentSummary& segment : summary.segments) {
    v1::InterfaceInfo::Segment& to = *info.add_segments();
    to.set_kind(from_kind(segment.kind));
    to.set_inclusion(segment.inclusion);
    to.set_begin(segment.begin);
    to.set_end(segment.end);
    to.set_edge_count(segment.edge_count);
  }
  return info;
}

v1::SubdomainInfo from_subdomain(const store::SubdomainSummary& summary) {
  v1::SubdomainInfo info;
  info.set_name(summary.name);
  info.set_node_count(summary.node_count);
  info.set_triangle_count(summary.triangle_count);
  info.set_area(summary.area);
  info.set_tension(summary.tension);
  info.set_floating(summary.floating);
  info.set_minimum_angle(summary.minimum_angle);
  info.set_shortest_edge(summary.shortest_edge);
  info.set_longest_edge(summary.longest_edge);
  return info;
}

v1::TipInfo from_tip(const store::TipSummary& summary) {
  v1::TipInfo info;
  info.mutable_at()->set_x(summary.at[0]);
  info.mutable_at()->set_y(summary.at[1]);
  info.set_interface(summary.interface);
  info.set_smallest_edge(summary.smallest_edge);
  return info;
}

}  // namespace

v1::Mesh from_domain(const store::MeshRecord& record, bool pinned) {
  v1::Mesh mesh;
  mesh.set_name(mesh_name(record.id));
  mesh.set_title(record.title);
  mesh.set_state(from_state(record.state));
  if (record.error) *mesh.mutable_error() = to_message(*record.error);
  *mesh.mutable_create_time() = to_timestamp(record.created);
  mesh.set_sha256(record.sha256);
  mesh.set_node_count(record.node_count);
  mesh.set_triangle_count(record.triangle_count);
  for (const store::SubdomainSummary& subdomain : record.subdomains) {
    *mesh.add_subdomains() = from_subdomain(subdomain);
  }
  for (const store::InterfaceSummary& interface : record.interfaces) {
    *mesh.add_interfaces() = from_interface(interface);
  }
  mesh.mutable_inclusions()->Add(record.inclusions.begin(), record.inclusions.end());
  mesh.mutable_warnings()->Add(record.warnings.begin(), record.warnings.end());
  mesh.set_minimum_angle(record.minimum_angle);
  mesh.set_bisection_bound(record.bisection_bound);
  for (const store::TipSummary& tip : record.tips) *mesh.add_tips() = from_tip(tip);
  mesh.set_dirichlet_length(record.dirichlet_length);
  mesh.set_neumann_length(record.neumann_length);
  mesh.set_operator_bytes(record.operator_bytes);
  mesh.set_theta_star(record.theta_star);
  mesh.set_mesh_seconds(record.mesh_seconds);
  mesh.set_factorize_seconds(record.factorize_seconds);
  mesh.set_owner(record.owner);
  mesh.set_pinned(pinned);
  return mesh;
}

}  // namespace anticrack::rpc
