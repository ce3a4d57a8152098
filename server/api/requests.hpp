// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests as the domain understands them. Pure functions; each checks what the domain's types
// cannot express (unset alternatives, names, counts before anything is allocated for them, what
// this version does not implement) and throws errors::Error with the field at fault, as a path in
// the request. What the values mean is checked below, by the domain.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "errors/errors.hpp"
#include "store/records.hpp"

namespace anticrack::api {

/// Points of one geometry: its check is quadratic in them.
constexpr std::size_t max_vertices = 10'000;
/// Inclusions, cracks and delaminated parts of one geometry, together.
constexpr std::size_t max_parts = 1'000;
/// Interfaces of one geometry, and lines its mesh is to follow.
constexpr std::size_t max_interfaces = 1'000;
/// Subdomains named in one geometry, groups named for one upload.
constexpr std::size_t max_regions = 1'000;
constexpr std::size_t max_title_bytes = 200;
constexpr std::size_t max_request_id_bytes = 64;
/// A job's own bytes come back in every answer about it, which must stay below 4 MiB; but for a
/// matrix that came with it.
constexpr std::size_t max_job_bytes = 1u << 20;
/// Of a matrix that comes with the job; a larger one is uploaded before.
constexpr std::size_t max_packed_bytes = 1u << 20;

/// What the mesh is to be made from, options filled in.
store::MeshDefinition to_definition(const v1::CreateMeshRequest& request);

/// The limits a job is held against before it is converted.
struct JobLimits {
  int load_cases = 0;
  int iterations = 0;
  std::chrono::milliseconds queue_time{0};
  std::chrono::milliseconds run_time{0};
};

/// The job, defaults filled in but for time limits. A sweep has no rows yet, and a matrix that came
/// with the job is named by its hash: keep_packed_matrix() makes it the upload of that name.
store::JobSpec to_spec(const v1::Job& job, const JobLimits& limits);

/// A sweep's matrix and its path in the job.
struct MatrixOf {
  const v1::Sweep::Matrix* matrix = nullptr;  ///< null: none is set
  std::string field;                          ///< "sweep.coefficients"; "sweep" where none is set
};
/// Of whichever kind of cases is set.
MatrixOf matrix_of(const v1::Sweep& sweep);

/// Throws unless there are at most `limit` of `what` ("vertices").
void require_count(std::size_t count, std::size_t limit, const std::string& field,
                   const char* what);
/// Throws unless `title` is at most max_title_bytes.
void require_title(const std::string& title, const char* field);
/// Throws unless `id` is empty or something like a UUID.
void require_request_id(const std::string& id);

/// The same error with the path of every field put through what the request's shape asks for:
/// geometry errors come relative to the geometry, those of options and upload as they are.
errors::Error below_mesh_request(const errors::Error& error);
/// Job errors come relative to the job; one without a field that is `not_found` is about its mesh.
errors::Error below_job_request(const errors::Error& error);

}  // namespace anticrack::api
