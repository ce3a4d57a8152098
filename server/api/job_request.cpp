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

void require_loads(const v1::Job& job) {
  for (int i = 0; i < job.load_cases_size(); ++i) {
    const v1::LoadCase& load = job.load_cases(i);
    const std::string field = fmt::format("job.load_cases[{}]", i);
    require_count(load.force().per_region().values().size(), fem::max_named_forces,
                  field + ".force.per_region", "regions");
    require_count(load.point_forces().size(), fem::max_point_forces, field + ".point_forces",
                  "point forces");
    require_count(load.inclusion_forces().size(), fem::max_named_forces,
                  field + ".inclusion_forces", "forces on inclusions");
    require_count(load.inclusion_moments().size(), fem::max_named_forces,
                  field + ".inclusion_moments", "moments on inclusions");
    if (load.force().has_array())
      upload_sha256(load.force().array().upload(), field + ".force.array.upload");
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
                fmt::format("a time of {} s: at most {} s are allowed (see GetServerInfo)",
                            duration.seconds(), limit))
        .at(field);
  }
}

std::size_t packed_bytes(const v1::Job& job) {
  const v1::Sweep::Matrix* matrix = matrix_of(job.sweep()).matrix;
  return matrix == nullptr ? 0 : matrix->packed().size();
}

void require_packed(const std::string& packed, const std::string& field) {
  if (packed.size() > max_packed_bytes) {
    throw Error(Reason::limit_exceeded,
                fmt::format("a matrix of {} bytes: a job may contain at most {}; upload it with "
                            "CreateUploads as KIND_ARRAY and name it in `upload`",
                            packed.size(), max_packed_bytes))
        .at(field);
  }
  if (packed.empty() || packed.size() % sizeof(double) != 0) {
    throw Error(Reason::invalid_argument,
                fmt::format("a matrix of {} bytes: give at least one value, each of 8 bytes (f64, "
                            "little-endian)",
                            packed.size()))
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

void require_sweep(const v1::Sweep& sweep, const JobLimits& limits) {
  const auto [matrix, path] = matrix_of(sweep);
  const std::string field = std::string("job.") + path;
  if (matrix == nullptr) {
    throw Error(Reason::invalid_argument,
                "the sweep has no cases; set coefficients or nodal_forces")
        .at(field);
  }
  if (sweep.traces_size() > limits.load_cases) {
    throw Error(Reason::limit_exceeded,
                fmt::format("traces of {} rows: at most {} are kept (see GetServerInfo)",
                            sweep.traces_size(), limits.load_cases))
        .at("job.sweep.traces");
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

std::string fingerprint(const v1::Job& job) {
  v1::Job sent = job;
  for (int number :
       {v1::Job::kNameFieldNumber, v1::Job::kStateFieldNumber, v1::Job::kErrorFieldNumber,
        v1::Job::kCreateTimeFieldNumber, v1::Job::kStartTimeFieldNumber,
        v1::Job::kEndTimeFieldNumber, v1::Job::kAnswersFieldNumber,
        v1::Job::kResultBytesFieldNumber, v1::Job::kAttemptFieldNumber, v1::Job::kOwnerFieldNumber,
        v1::Job::kTimelineFieldNumber, v1::Job::kSweepAnswerFieldNumber,
        v1::Job::kStagesFieldNumber, v1::Job::kNotReachedFieldNumber,
        v1::Job::kResultStateFieldNumber, v1::Job::kExpireTimeFieldNumber,
        v1::Job::kLoadCaseCountFieldNumber, v1::Job::kLoadCasesEndedFieldNumber})
    sent.GetReflection()->ClearField(&sent, sent.GetDescriptor()->FindFieldByNumber(number));
  if (packed_bytes(job) > 0) {  // names the same matrix by its upload
    auto& sweep = *sent.mutable_sweep();
    auto& matrix =
        sweep.has_coefficients() ? *sweep.mutable_coefficients() : *sweep.mutable_nodal_forces();
    matrix.set_upload(upload_name(digest::Sha256().add(matrix.packed()).finish()));
  }
  return digest::Sha256().add(serialized(sent)).finish();
}

records::JobSpec to_spec(const v1::Job& job, const JobLimits& limits) {
  require_title(job.title(), "job.title");
  if (job.load_cases_size() > limits.load_cases) {
    throw Error(Reason::limit_exceeded,
                fmt::format("{} load cases: a job has at most {}; make several jobs",
                            job.load_cases_size(), limits.load_cases))
        .at("job.load_cases");
  }
  const std::size_t bytes = job.ByteSizeLong() - packed_bytes(job);
  if (bytes > max_job_bytes) {
    throw Error(Reason::limit_exceeded,
                fmt::format("the job has {} bytes: at most {} are accepted; make several jobs",
                            bytes, max_job_bytes))
        .at("job");
  }
  mesh_id(job.mesh(), "job.mesh");
  if (job.has_queue_timeout())
    require_time(job.queue_timeout(), limits.queue_time, "job.queue_timeout");
  if (job.has_run_timeout()) require_time(job.run_timeout(), limits.run_time, "job.run_timeout");
  if (job.accuracy().has_time())
    require_time(job.accuracy().time(), limits.run_time, "job.accuracy.time");
  require_loads(job);
  if (job.has_sweep()) require_sweep(job.sweep(), limits);
  records::JobSpec spec;
  try {
    spec = Translation<records::JobSpec>::read(job);
  } catch (Error& error) {
    throw error.below("job");
  }
  bound_iterations(job.solver(), limits.iterations, spec.solver);
  if (packed_bytes(job) > 0)
    spec.sweep->upload = digest::Sha256().add(matrix_of(job.sweep()).matrix->packed()).finish();
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
