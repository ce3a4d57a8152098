// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <variant>

#include "anticrack/v1/solve.pb.h"
#include "api/names.hpp"
#include "api/translations.hpp"
#include "records/case_record.hpp"

namespace anticrack::api {

using contact::KktResiduals;
using errors::Error;
using errors::Reason;
using std::chrono::milliseconds;

// Enums travel as their numbers.
static_assert(int(contact::Status::cancelled) == v1::LoadCaseAnswer::STATUS_CANCELLED);
static_assert(int(contact::Mass::consistent) == v1::MASS_CONSISTENT);
static_assert(int(records::JobState::not_converged) == v1::JobStatus::STATE_NOT_CONVERGED);
static_assert(int(records::Priority::bulk) == v1::JobSpec::PRIORITY_BULK);

namespace {

/// Absolute and relative residuals share a message.
constexpr const char* relative = "_relative";

/// Writes a time limit, unless it is 0.
void write_limit(milliseconds limit, Message& to, const char* name) {
  if (limit.count() > 0) write_field(std::chrono::nanoseconds(limit), to, name);
}

/// A limit in milliseconds, rounded up so that a short one does not become 0 (unset).
milliseconds limit_of(const Message& from, const char* name) {
  return std::chrono::ceil<milliseconds>(read_one<std::chrono::nanoseconds>(from, name));
}

v1::JobStatus::ResultState result_state(const records::JobRecord& record) {
  if (!records::ended(record.state)) return v1::JobStatus::RESULT_STATE_PENDING;
  if (record.expired) return v1::JobStatus::RESULT_STATE_EXPIRED;
  return record.result_bytes > 0 ? v1::JobStatus::RESULT_STATE_AVAILABLE
                                 : v1::JobStatus::RESULT_STATE_NONE;
}

}  // namespace

void Translation<fem::Force>::write(const fem::Force& value, v1::Force& to) {
  struct Visitor {
    v1::Force& to;
    void operator()(double constant) const { to.set_constant(constant); }
    void operator()(const fem::Expression& expression) const {
      write_field(expression.text, to, "expression");
    }
    void operator()(const fem::PerRegion& regions) const {
      write_fields(regions, *to.mutable_per_region());
    }
    void operator()(const fem::Array& array) const {
      write_fields(array, *to.mutable_array(), {"upload", "values"});
      write_field(upload_name(array.upload), *to.mutable_array(), "upload");
    }
  };
  std::visit(Visitor{to}, value);
}

fem::Force Translation<fem::Force>::read(const v1::Force& from) {
  switch (from.kind_case()) {
    case v1::Force::KIND_NOT_SET:
      return 0.0;
    case v1::Force::kConstant:
      return from.constant();
    case v1::Force::kExpression:
      return fem::Expression{from.expression()};
    case v1::Force::kPerRegion:
      return Translation<fem::PerRegion>::read(from.per_region());
    case v1::Force::kArray:
      return fem::Array{after_slash(from.array().upload(), "array.upload"),
                        from.array().per_triangle(), nullptr};
  }
  throw Error(Reason::invalid_argument, "unknown kind of force");
}

void Translation<fem::PointForce>::write(const fem::PointForce& value, v1::PointForce& to) {
  to.mutable_at()->set_x(value.x);
  to.mutable_at()->set_y(value.y);
  to.set_value(value.value);
}

fem::PointForce Translation<fem::PointForce>::read(const v1::PointForce& from) {
  if (!from.has_at()) {
    throw Error(Reason::invalid_argument, "the point force does not say where it acts; set `at`")
        .at("at");
  }
  return {from.at().x(), from.at().y(), from.value()};
}

void Translation<contact::UzawaOptions>::write(const contact::UzawaOptions& value, v1::Uzawa& to) {
  write_fields(value, to, {"theta"});
  if (value.theta)
    to.set_theta(*value.theta);
  else
    to.set_theta_auto(true);
}

contact::UzawaOptions Translation<contact::UzawaOptions>::read(const v1::Uzawa& from) {
  contact::UzawaOptions value;
  read_fields(from, value, {"theta"});
  if (from.has_theta()) value.theta = from.theta();
  if (from.has_theta_auto()) {
    if (!from.theta_auto()) {
      throw Error(Reason::invalid_argument, "theta_auto = false chooses nothing; set theta instead")
          .at("theta_auto");
    }
    value.theta.reset();
  }
  return value;
}

void Translation<contact::ActiveSetOptions>::write(const contact::ActiveSetOptions& value,
                                                   v1::ActiveSet& to) {
  write_fields(value, to);
}

contact::ActiveSetOptions Translation<contact::ActiveSetOptions>::read(const v1::ActiveSet& from) {
  contact::ActiveSetOptions value;
  read_fields(from, value);
  return value;
}

void Translation<contact::SolverOptions>::write(const contact::SolverOptions& value,
                                                v1::Solver& to) {
  if (const auto* uzawa = std::get_if<contact::UzawaOptions>(&value))
    write_field(*uzawa, to, "uzawa");
  else
    write_field(std::get<contact::ActiveSetOptions>(value), to, "active_set");
}

contact::SolverOptions Translation<contact::SolverOptions>::read(const v1::Solver& from) {
  if (from.has_uzawa()) return read_one<contact::UzawaOptions>(from, "uzawa");
  return read_one<contact::ActiveSetOptions>(from, "active_set");
}

void Translation<records::SweepSpec>::write(const records::SweepSpec& value, v1::Sweep& to) {
  write_fields(value, to, {"cases", "upload", "rows", "packed"});
  v1::Sweep::Matrix& matrix = value.cases == records::SweepSpec::Cases::combinations
                                  ? *to.mutable_coefficients()
                                  : *to.mutable_nodal_forces();
  if (value.packed)
    write_field(value.upload, matrix, "sha256");
  else
    write_field(upload_name(value.upload), matrix, "upload");
}

records::SweepSpec Translation<records::SweepSpec>::read(const v1::Sweep& from) {
  records::SweepSpec value;
  read_fields(from, value, {"cases", "upload", "rows", "packed"});
  const bool nodal = from.has_nodal_forces();
  value.cases =
      nodal ? records::SweepSpec::Cases::nodal_forces : records::SweepSpec::Cases::combinations;
  const v1::Sweep::Matrix& matrix = nodal ? from.nodal_forces() : from.coefficients();
  value.packed = !matrix.has_upload();
  value.upload = value.packed ? matrix.sha256() : after_slash(matrix.upload(), "upload");
  return value;
}

void Translation<records::CaseRecord>::write(const records::CaseRecord& value,
                                             v1::LoadCaseAnswer& to) {
  write_fields(value, to, {"answer"});
  write_fields(value.answer, to, {"kkt_relative"});
  if (value.answer.theta == 0) to.clear_theta();
  if (value.answer.theta_star == 0) to.clear_theta_star();
  fields::for_each(value.answer.kkt_relative, [&](const fields::Field<const double>& residual) {
    write_field(residual.value, *to.mutable_kkt(), std::string(residual.name) + relative);
  });
}

records::CaseRecord Translation<records::CaseRecord>::read(const v1::LoadCaseAnswer& from) {
  records::CaseRecord value;
  read_fields(from, value, {"answer"});
  read_fields(from, value.answer, {"kkt_relative"});
  fields::for_each(value.answer.kkt_relative, [&](const fields::Field<double>& residual) {
    residual.value = read_one<double>(from.kkt(), std::string(residual.name) + relative);
  });
  return value;
}

void Translation<records::AccuracySpec>::write(const records::AccuracySpec& value,
                                               v1::Accuracy& to) {
  write_fields(value, to, {"time"});
  write_limit(value.time, to, "time");
}

records::AccuracySpec Translation<records::AccuracySpec>::read(const v1::Accuracy& from) {
  records::AccuracySpec value;
  read_fields(from, value, {"time"});
  value.time = limit_of(from, "time");
  return value;
}

void Translation<records::StageRecord>::write(const records::StageRecord& value, v1::Stage& to) {
  write_fields(value, to, {"mesh"});
  to.set_mesh(mesh_name(value.mesh));
}

records::StageRecord Translation<records::StageRecord>::read(const v1::Stage& from) {
  records::StageRecord value;
  read_fields(from, value, {"mesh"});
  value.mesh = after_slash(from.mesh(), "mesh");
  return value;
}

const Except of_spec{
    "mesh", "loads", "fields", "indicators", "balanced_flux", "queue_time_limit", "run_time_limit"};

bool asks_for(const v1::JobSpec& spec, v1::Output output) {
  return std::ranges::find(spec.outputs(), output) != spec.outputs().end();
}

void Translation<records::JobSpec>::write(const records::JobSpec& value, v1::JobSpec& to) {
  write_fields(value, to, of_spec);
  write_field(mesh_name(value.mesh), to, "mesh");
  write_field(value.loads, to, "load_cases");
  if (value.fields) to.add_outputs(v1::OUTPUT_FIELDS);
  if (value.indicators) to.add_outputs(v1::OUTPUT_INDICATORS);
  if (value.balanced_flux) to.add_outputs(v1::OUTPUT_BALANCED_FLUX);
  write_limit(value.queue_time_limit, to, "queue_timeout");
  write_limit(value.run_time_limit, to, "run_timeout");
}

records::JobSpec Translation<records::JobSpec>::read(const v1::JobSpec& from) {
  records::JobSpec value;
  read_fields(from, value, of_spec);
  value.mesh = after_slash(from.mesh(), "mesh");
  read_field(from, "load_cases", value.loads);
  value.fields = asks_for(from, v1::OUTPUT_FIELDS);
  value.indicators = asks_for(from, v1::OUTPUT_INDICATORS);
  value.balanced_flux = asks_for(from, v1::OUTPUT_BALANCED_FLUX);
  value.queue_time_limit = limit_of(from, "queue_timeout");
  value.run_time_limit = limit_of(from, "run_timeout");
  return value;
}

/// What its message has elsewhere, under another name or not at all.
const Except of_status{"id",    "owner",   "request_id", "spec",  "created", "started",
                       "ended", "expired", "cases",      "sweep", "crashes"};

void Translation<records::JobRecord>::write(const records::JobRecord& value, v1::Job& to) {
  write_field(job_name(value.id), to, "name");
  write_field(value.owner, to, "owner");
  write_field(value.spec, to, "spec");
  v1::JobStatus& status = *to.mutable_status();
  write_fields(value, status, of_status);
  write_field(value.created, status, "create_time");
  write_field(value.started, status, "start_time");
  write_field(value.ended, status, "end_time");
  write_field(value.expired, status, "expire_time");
  status.set_result_state(result_state(value));
  write_field(value.cases, status, "answers");
  for (std::size_t i = 0; i < std::min(value.cases.size(), value.spec.loads.size()); ++i)
    status.mutable_answers(static_cast<int>(i))->set_name(value.spec.loads[i].name);
  if (value.spec.sweep) {
    write_field(value.sweep, status, "sweep_answer");
    status.mutable_sweep_answer()->set_rows(value.spec.sweep->rows);
  }
  // A job that is queued again begins a new attempt.
  int attempt = 1;
  for (int i = 0; i < status.timeline_size(); ++i) {
    v1::JobStatus::Step& step = *status.mutable_timeline(i);
    if (i > 0 && step.state() == v1::JobStatus::STATE_QUEUED &&
        status.timeline(i - 1).state() != v1::JobStatus::STATE_QUEUED)
      attempt = std::min(attempt + 1, value.attempt);
    step.set_attempt(attempt);
  }
}

records::JobRecord Translation<records::JobRecord>::read(const v1::Job& from) {
  const v1::JobStatus& status = from.status();
  records::JobRecord value;
  value.id = after_slash(from.name(), "name");
  value.owner = from.owner();
  value.spec = Translation<records::JobSpec>::read(from.spec());
  read_fields(status, value, of_status);
  read_field(status, "create_time", value.created);
  read_field(status, "start_time", value.started);
  read_field(status, "end_time", value.ended);
  read_field(status, "expire_time", value.expired);
  read_field(status, "answers", value.cases);
  if (value.spec.sweep) {
    read_field(status, "sweep_answer", value.sweep);
    value.spec.sweep->rows = status.sweep_answer().rows();
  }
  return value;
}

}  // namespace anticrack::api
