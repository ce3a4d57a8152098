// SPDX-License-Identifier: GPL-3.0-or-later
//
// Translates requests to the structs of the domain. The functions are pure. Each checks what the
// structs cannot express (unset alternatives, names, counts) and throws errors::Error with the path
// of the field in the request. The domain checks the values.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "anticrack/v1/job.pb.h"
#include "anticrack/v1/mesh.pb.h"
#include "errors/errors.hpp"
#include "records/job_spec.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::api {

/// Most points of one geometry, as its check is quadratic in their number.
constexpr std::size_t max_vertices = 10'000;
/// Most inclusions, cracks and delaminated parts of one geometry, together.
constexpr std::size_t max_parts = 1'000;
/// Most interfaces of one geometry, and most lines for its mesh to follow.
constexpr std::size_t max_interfaces = 1'000;
/// Most sides of one boundary, and most holes in it.
constexpr std::size_t max_sides = 1'000;
/// Most subdomains named in one geometry, and most groups named for one upload.
constexpr std::size_t max_regions = 1'000;
constexpr std::size_t max_title_bytes = 200;
/// Most bytes of a job without its matrix, as every answer repeats them and must stay below 4 MiB.
constexpr std::size_t max_job_bytes = 1u << 20;
/// Most bytes of a matrix inside a job; a larger one must be uploaded.
constexpr std::size_t max_packed_bytes = 1u << 20;

/// The definition of a mesh, with options filled in.
records::MeshDefinition to_definition(const v1::CreateMeshRequest& request);

/// SHA-256 of a spec as it was sent: neither defaults nor limits of the server change it. A packed
/// matrix and its upload have the same. 64 hexadecimal digits.
std::string fingerprint(const v1::JobSpec& spec);

/// The limits of a job.
struct JobLimits {
  int iterations = 0;
  std::chrono::milliseconds queue_time{0};
  std::chrono::milliseconds run_time{0};
};

/// The spec, defaults filled in except time limits. The rows of a sweep are not set; a matrix
/// inside it is named by its hash, under which keep_packed_matrix() stores it. The paths of errors
/// are relative to the spec; that of one of the whole is empty.
records::JobSpec to_spec(const v1::JobSpec& asked, const JobLimits& limits);

/// A sweep's matrix and its path in the spec.
struct MatrixOf {
  const v1::Sweep::Matrix* matrix = nullptr;  ///< null: none is set
  std::string field;                          ///< "sweep.coefficients"; "sweep" where none is set
};
/// The matrix of the kind of cases that is set.
MatrixOf matrix_of(const v1::Sweep& sweep);

/// Throws unless `title` is at most max_title_bytes.
void require_title(const std::string& title, const char* field);
/// Throws unless `id` is empty or 1 to 64 letters, digits, '-' and '_'.
void require_request_id(const std::string& id);

/// The error with paths in the mesh request: fields are relative to the geometry, except options
/// and uploads.
errors::Error below_mesh_request(const errors::Error& error);
/// The error with paths in the job request: fields are relative to the spec; `not_found` without a
/// field concerns its mesh.
errors::Error below_job_request(const errors::Error& error);

}  // namespace anticrack::api
