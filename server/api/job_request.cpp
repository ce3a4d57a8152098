// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>

#include "api/names.hpp"
#include "api/requests.hpp"
#include "api/translations.hpp"
#include "digest/digest.hpp"

namespace anticrack::api {
namespace {

using errors::Error;
using errors::Reason;

void require_arrays(const v1::JobSpec& asked) {
  for (int i = 0; i < asked.load_cases_size(); ++i) {
    const v1::Force& force = asked.load_cases(i).force();
    if (force.has_array())
      upload_sha256(force.array().upload(), fmt::format("load_cases[{}].force.array.upload", i));
  }
}

/// Compares in milliseconds, rounded up as on reading.
void require_time(const google::protobuf::Duration& duration, std::chrono::milliseconds longest,
                  const std::string& field) {
  constexpr std::int64_t second = 1'000'000'000;
  if (duration.seconds() < 0 || duration.nanos() < 0 || duration.nanos() >= second ||
      duration.seconds() + duration.nanos() == 0) {
    throw Error(Reason::invalid_argument,
                "the time is not a duration of more than 0 s with 0 to 999999999 ns; leave it "
                "out for the server's")
        .at(field);
  }
  const auto limit = std::chrono::floor<std::chrono::seconds>(longest).count();
  const std::int64_t milliseconds =
      duration.seconds() > limit
          ? std::numeric_limits<std::int64_t>::max()  // a product would overflow
          : 1000 * duration.seconds() + (duration.nanos() + 999'999) / 1'000'000;
  if (milliseconds > longest.count()) {
    throw Error(Reason::limit_exceeded,
                "a time of {} s: at most {} s are allowed (see GetServerInfo)", duration.seconds(),
                limit)
        .at(field);
  }
}

std::size_t packed_bytes(const v1::JobSpec& asked) {
  const v1::Sweep::Matrix* matrix = matrix_of(asked.sweep()).matrix;
  return matrix == nullptr ? 0 : matrix->packed().size();
}

void require_packed(const std::string& packed, const std::string& field) {
  if (packed.size() > max_packed_bytes) {
    throw Error(Reason::limit_exceeded,
                "a matrix of {} bytes: a job may contain at most {}; upload it with "
                "CreateUploads as KIND_ARRAY and name it in `upload`",
                packed.size(), max_packed_bytes)
        .at(field);
  }
  if (packed.empty() || packed.size() % sizeof(double) != 0) {
    throw Error(Reason::invalid_argument,
                "a matrix of {} bytes: give at least one value, each of 8 bytes (f64, "
                "little-endian)",
                packed.size())
        .at(field);
  }
}

void require_matrix(const v1::Sweep::Matrix& matrix, const std::string& field) {
  switch (matrix.source_case()) {
    case v1::Sweep::Matrix::kPacked:
      return require_packed(matrix.packed(), field + ".packed");
    case v1::Sweep::Matrix::kUpload:
      upload_sha256(matrix.upload(), field + ".upload");
      return;
    case v1::Sweep::Matrix::SOURCE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "the matrix has no values; set packed or upload").at(field);
}

void require_sweep(const v1::Sweep& sweep) {
  const auto [matrix, field] = matrix_of(sweep);
  if (matrix == nullptr) {
    throw Error(Reason::invalid_argument,
                "the sweep has no cases; set coefficients or nodal_forces")
        .at(field);
  }
  require_matrix(*matrix, field);
}

/// Limits the default number of iterations to what the server allows.
void bound_iterations(const v1::Solver& asked, int limit, contact::SolverOptions& options) {
  if (auto* uzawa = std::get_if<contact::UzawaOptions>(&options)) {
    if (!asked.uzawa().has_max_iterations())
      uzawa->max_iterations = std::min(uzawa->max_iterations, limit);
  } else if (!asked.active_set().has_max_steps()) {
    int& steps = std::get<contact::ActiveSetOptions>(options).max_steps;
    steps = std::min(steps, limit);
  }
}

}  // namespace

std::string fingerprint(const v1::JobSpec& spec) {
  v1::JobSpec sent = spec;
  if (packed_bytes(spec) > 0) {  // names the same matrix by its upload
    auto& sweep = *sent.mutable_sweep();
    auto& matrix =
        sweep.has_coefficients() ? *sweep.mutable_coefficients() : *sweep.mutable_nodal_forces();
    matrix.set_upload(upload_name(digest::Sha256().add(matrix.packed()).finish()));
  }
  return digest::Sha256().add(serialized(sent)).finish();
}

records::JobSpec to_spec(const v1::JobSpec& asked, const JobLimits& limits) {
  require_title(asked.title(), "title");
  const std::size_t bytes = asked.ByteSizeLong() - packed_bytes(asked);
  if (bytes > max_job_bytes) {
    throw Error(Reason::limit_exceeded,
                "the job has {} bytes: at most {} are accepted; make several jobs", bytes,
                max_job_bytes)
        .at("");
  }
  mesh_id(asked.mesh(), "mesh");
  if (asked.has_queue_timeout())
    require_time(asked.queue_timeout(), limits.queue_time, "queue_timeout");
  if (asked.has_run_timeout()) require_time(asked.run_timeout(), limits.run_time, "run_timeout");
  if (asked.accuracy().has_time())
    require_time(asked.accuracy().time(), limits.run_time, "accuracy.time");
  require_arrays(asked);
  if (asked.has_sweep()) require_sweep(asked.sweep());
  auto spec = Translation<records::JobSpec>::read(asked);
  bound_iterations(asked.solver(), limits.iterations, spec.solver);
  if (packed_bytes(asked) > 0)
    spec.sweep->upload = digest::Sha256().add(matrix_of(asked.sweep()).matrix->packed()).finish();
  return spec;
}

MatrixOf matrix_of(const v1::Sweep& sweep) {
  switch (sweep.cases_case()) {
    case v1::Sweep::kCoefficients:
      return {&sweep.coefficients(), "sweep.coefficients"};
    case v1::Sweep::kNodalForces:
      return {&sweep.nodal_forces(), "sweep.nodal_forces"};
    case v1::Sweep::CASES_NOT_SET:
      break;
  }
  return {nullptr, "sweep"};
}

void require_request_id(const std::string& id) {
  if (id.empty() || is_id(id)) return;
  throw Error(Reason::invalid_argument,
              "request_id is not a UUID, e.g. 123e4567-e89b-12d3-a456-426614174000")
      .at("request_id");
}

}  // namespace anticrack::api
