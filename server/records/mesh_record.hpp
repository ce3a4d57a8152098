// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the server remembers of meshes. The numbers of enums are those of the API.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "errors/errors.hpp"
#include "fields/fields.hpp"
#include "mesh/geometry.hpp"
#include "records/clock.hpp"

namespace anticrack::records {

/// An uploaded .msh, by the sha256 of its bytes; the file lies in the store's folder.
struct UploadRef {
  std::string sha256;
  mesh::MeshOptions options{};
};
ANTICRACK_FIELDS(UploadRef, sha256, options)

struct GeometrySource {
  mesh::Geometry geometry;
  mesh::MeshOptions options;
};
ANTICRACK_FIELDS(GeometrySource, geometry, options)

/// Another mesh, whose triangles were bisected for a job.
struct Refinement {
  std::string parent;         ///< id; the mesh may have been erased
  std::string job;            ///< id of the job
  std::string levels_sha256;  ///< hash of mesh::refine()'s levels
};
ANTICRACK_FIELDS(Refinement, parent, job, levels_sha256)

/// The source of a mesh; the mesh's identity is the hash of this.
using MeshDefinition = std::variant<GeometrySource, UploadRef, Refinement>;

enum class MeshState { pending = 1, meshing, factorizing, ready, evicted, failed };

struct SubdomainSummary {
  std::string name;
  std::uint64_t node_count = 0;
  std::uint64_t triangle_count = 0;
  double area = 0;
  double tension = 1;
  bool floating = false;     ///< interfaces alone hold a part of it
  double minimum_angle = 0;  ///< degrees
  double shortest_edge = 0;
  double longest_edge = 0;
  std::optional<mesh::TensionLaw> tension_law{};  ///< the law; `tension` is its mean
};
ANTICRACK_FIELDS(SubdomainSummary, name, node_count, triangle_count, area, tension, floating,
                 minimum_angle, shortest_edge, longest_edge, tension_law)

struct TipSummary {
  mesh::Point at{};
  std::string interface;
  double smallest_edge = 0;
};
ANTICRACK_FIELDS(TipSummary, at, interface, smallest_edge)

struct SegmentSummary {
  mesh::Kind kind = mesh::Kind::glue;
  std::int32_t inclusion = -1;
  double begin = 0;
  double end = 0;
  std::uint64_t edge_count = 0;
};
ANTICRACK_FIELDS(SegmentSummary, kind, inclusion, begin, end, edge_count)

struct InterfaceSummary {
  std::string name;
  double length = 0;
  std::uint64_t node_count = 0;
  std::vector<SegmentSummary> segments;
  std::optional<mesh::Point> start{};  ///< the point where its arc length is 0
};
ANTICRACK_FIELDS(InterfaceSummary, name, length, node_count, segments, start)

/// The progress of a mesh in the mesher.
struct MeshProgress {
  std::string doing;                     ///< "bisecting a mesh"
  std::uint64_t triangles = 0;           ///< so far; 0: not counted
  std::uint64_t expected_triangles = 0;  ///< 0: not known
  bool operator==(const MeshProgress&) const = default;
};
ANTICRACK_FIELDS(MeshProgress, doing, triangles, expected_triangles)

struct MeshRecord {
  std::string id;     ///< first 16 digits of the hash of definition and owner
  std::string owner;  ///< identity of its creator; empty on a server without authentication
  std::string title;
  MeshDefinition definition;
  MeshState state = MeshState::pending;
  std::optional<errors::Error> error;  ///< when failed
  Clock::time_point created;
  // Known once meshed:
  std::string sha256;  ///< of mesh::encode(mesh): the key of the operators
  std::uint64_t node_count = 0;
  std::uint64_t triangle_count = 0;
  std::vector<SubdomainSummary> subdomains;
  std::vector<InterfaceSummary> interfaces;
  std::vector<std::string> inclusions;
  std::vector<std::string> warnings;
  double minimum_angle = 0;
  double bisection_bound = 0;  ///< degrees; 0: not graded
  std::vector<TipSummary> tips;
  double dirichlet_length = 0;
  double neumann_length = 0;
  double mesh_seconds = 0;
  // Known once factorised:
  std::uint64_t operator_bytes = 0;
  double factorize_seconds = 0;
  // Further members:
  std::optional<MeshProgress> progress{};  ///< while it is meshed; not on the disk
  bool for_job = false;                    ///< only jobs want it
};
ANTICRACK_FIELDS(MeshRecord, id, owner, title, definition, state, error, created, sha256,
                 node_count, triangle_count, subdomains, interfaces, inclusions, warnings,
                 minimum_angle, bisection_bound, tips, dirichlet_length, neumann_length,
                 mesh_seconds, operator_bytes, factorize_seconds, progress, for_job)

}  // namespace anticrack::records
