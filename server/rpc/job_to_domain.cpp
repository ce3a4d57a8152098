// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "rpc/names.hpp"
#include "rpc/to_domain.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

void require_count(std::size_t count, std::size_t limit, const char* what,
                   const std::string& field) {
  if (count > limit) {
    throw Error(Reason::limit_exceeded, std::to_string(count) + " " + what + ": at most " +
                                            std::to_string(limit) + " are accepted")
        .at(field);
  }
}

fem::Force to_force(const v1::Force& force, const std::string& field) {
  switch (force.kind_case()) {
    case v1::Force::KIND_NOT_SET:
      return 0.0;
    case v1::Force::kConstant:
      return force.constant();
    case v1::Force::kExpression:
      return fem::Expression{force.expression()};
    case v1::Force::kPerRegion: {
      const auto& values = force.per_region().values();
      require_count(values.size(), fem::max_named_forces, "regions", field + ".per_region");
      return fem::PerRegion{{values.begin(), values.end()}};
    }
    case v1::Force::kArray:
      return fem::Array{upload_sha256(force.array().upload(), field + ".array.upload"),
                        force.array().per_triangle(), nullptr};
  }
  throw Error(Reason::invalid_argument, "unknown kind of force").at(field);
}

fem::Load to_load(const v1::LoadCase& load, const std::string& field) {
  fem::Load to;
  to.name = load.name();
  to.force = to_force(load.force(), field + ".force");
  to.boundary_value = load.boundary_value();
  to.traction = load.traction();
  require_count(static_cast<std::size_t>(load.point_forces_size()), fem::max_point_forces,
                "point forces", field + ".point_forces");
  to.point_forces.reserve(static_cast<std::size_t>(load.point_forces_size()));
  for (const v1::PointForce& force : load.point_forces()) {
    if (!force.has_at()) {
      throw Error(Reason::invalid_argument, "the point force does not say where it acts; set `at`")
          .at(field + ".point_forces[" + std::to_string(to.point_forces.size()) + "].at");
    }
    to.point_forces.push_back({force.at().x(), force.at().y(), force.value()});
  }
  require_count(load.inclusion_forces().size(), fem::max_named_forces, "forces on inclusions",
                field + ".inclusion_forces");
  to.inclusion_forces = {load.inclusion_forces().begin(), load.inclusion_forces().end()};
  return to;
}

contact::Mass to_mass(v1::Mass mass) {
  switch (mass) {
    case v1::MASS_UNSPECIFIED:
    case v1::MASS_LUMPED:
      return contact::Mass::lumped;
    case v1::MASS_CONSISTENT:
      return contact::Mass::consistent;
    default:
      throw Error(Reason::invalid_argument,
                  "mass " + std::to_string(mass) + " is unknown; use lumped (1) or consistent (2)")
          .at("job.solver.uzawa.mass");
  }
}

contact::UzawaOptions to_options(const v1::Uzawa& uzawa, int iteration_limit) {
  contact::UzawaOptions options;
  if (uzawa.step_case() == v1::Uzawa::kTheta) {
    options.theta = uzawa.theta();
  } else if (uzawa.step_case() == v1::Uzawa::kThetaAuto) {
    if (!uzawa.theta_auto()) {
      throw Error(Reason::invalid_argument, "theta_auto = false chooses nothing; set theta instead")
          .at("job.solver.uzawa.theta_auto");
    }
    options.theta.reset();
  }
  if (uzawa.has_epsilon()) options.epsilon = uzawa.epsilon();
  if (uzawa.has_p()) options.p = uzawa.p();
  options.max_iterations = uzawa.max_iterations() != 0
                               ? uzawa.max_iterations()
                               : std::min(options.max_iterations, iteration_limit);
  options.mass = to_mass(uzawa.mass());
  if (uzawa.has_kkt_tolerance()) options.kkt_tolerance = uzawa.kkt_tolerance();
  return options;
}

contact::ActiveSetOptions to_options(const v1::ActiveSet& active_set, int iteration_limit) {
  contact::ActiveSetOptions options;
  if (active_set.has_tolerance()) options.tolerance = active_set.tolerance();
  options.max_steps = active_set.max_steps() != 0 ? active_set.max_steps()
                                                  : std::min(options.max_steps, iteration_limit);
  return options;
}

contact::SolverOptions to_options(const v1::Solver& solver, int iteration_limit) {
  if (solver.has_uzawa()) return to_options(solver.uzawa(), iteration_limit);
  return to_options(solver.active_set(), iteration_limit);
}

store::Priority to_priority(v1::Job::Priority priority) {
  switch (priority) {
    case v1::Job::PRIORITY_UNSPECIFIED:
    case v1::Job::PRIORITY_NORMAL:
      return store::Priority::normal;
    case v1::Job::PRIORITY_INTERACTIVE:
      return store::Priority::interactive;
    case v1::Job::PRIORITY_BULK:
      return store::Priority::bulk;
    default:
      throw Error(Reason::invalid_argument,
                  "priority " + std::to_string(priority) +
                      " is unknown; use interactive (1), normal (2) or bulk (3)")
          .at("job.priority");
  }
}

/// 0 where it is unset: the server's. What is not 0 is rounded up to milliseconds, so that it does
/// not become that.
std::chrono::milliseconds to_time_limit(const google::protobuf::Duration& duration,
                                        std::chrono::milliseconds longest,
                                        const std::string& field) {
  constexpr std::int64_t second = 1'000'000'000;
  if (duration.seconds() < 0 || duration.nanos() < 0 || duration.nanos() >= second) {
    throw Error(Reason::invalid_argument,
                "the time is no duration of at least 0 s with 0 to 999999999 ns")
        .at(field);
  }
  const auto limit = std::chrono::floor<std::chrono::seconds>(longest).count();
  const std::int64_t milliseconds =
      duration.seconds() > limit
          ? std::numeric_limits<std::int64_t>::max()  // a product would overflow
          : 1000 * duration.seconds() + (duration.nanos() + 999'999) / 1'000'000;
  if (milliseconds > longest.count()) {
    throw Error(Reason::limit_exceeded, "a time of " + std::to_string(duration.seconds()) +
                                            " s: at most " + std::to_string(limit) +
                                            " s are allowed (see GetServerInfo)")
        .at(field);
  }
  return std::chrono::milliseconds(milliseconds);
}

std::size_t packed_bytes(const v1::Job& job) {
  const v1::Sweep::Matrix* matrix = matrix_of(job.sweep()).matrix;
  return matrix == nullptr ? 0 : matrix->packed().size();
}

}  // namespace

store::JobSpec to_spec(const v1::Job& job, const JobLimits& limits) {
  require_title(job.title(), "job.title");
  if (job.load_cases_size() > limits.load_cases) {
    throw Error(Reason::limit_exceeded,
                std::to_string(job.load_cases_size()) + " load cases: a job has at most " +
                    std::to_string(limits.load_cases) + "; make several jobs of it")
        .at("job.load_cases");
  }
  const std::size_t bytes = job.ByteSizeLong() - packed_bytes(job);
  if (bytes > max_job_bytes) {
    throw Error(Reason::limit_exceeded, "the job has " + std::to_string(bytes) +
                                            " bytes: at most " + std::to_string(max_job_bytes) +
                                            " are accepted; make several jobs of it")
        .at("job");
  }
  store::JobSpec spec;
  spec.title = job.title();
  spec.mesh = mesh_id(job.mesh(), "job.mesh");
  spec.fields = job.fields();
  spec.priority = to_priority(job.priority());
  spec.queue_time_limit =
      to_time_limit(job.queue_timeout(), limits.queue_time, "job.queue_timeout");
  spec.run_time_limit = to_time_limit(job.run_timeout(), limits.run_time, "job.run_timeout");
  spec.solver = to_options(job.solver(), limits.iterations);
  spec.loads.reserve(static_cast<std::size_t>(job.load_cases_size()));
  for (int i = 0; i < job.load_cases_size(); ++i) {
    spec.loads.push_back(to_load(job.load_cases(i), "job.load_cases[" + std::to_string(i) + "]"));
  }
  if (job.has_sweep()) spec.sweep = to_sweep(job, limits);
  return spec;
}

void require_request_id(const std::string& id) {
  const bool fits =
      id.size() <= max_request_id_bytes && std::all_of(id.begin(), id.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '-' || c == '_';
      });
  if (!fits) {
    throw Error(Reason::invalid_argument,
                "request_id is no UUID, e.g. 123e4567-e89b-12d3-a456-426614174000")
        .at("request_id");
  }
}

}  // namespace anticrack::rpc
