// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>
#include <variant>

#include "store/record_codec.hpp"
#include "store/record_parts.hpp"

namespace anticrack::store::disk {

using std::chrono::milliseconds;

constexpr std::array job_states{
    JobState::queued, JobState::waiting_for_mesh, JobState::running, JobState::succeeded,
    JobState::failed, JobState::cancelled,        JobState::expired};
constexpr std::array case_statuses{CaseStatus::pending,   CaseStatus::running,
                                   CaseStatus::converged, CaseStatus::not_converged,
                                   CaseStatus::failed,    CaseStatus::cancelled};
constexpr std::array priorities{Priority::interactive, Priority::normal, Priority::bulk};
constexpr std::array statuses{contact::Status::converged, contact::Status::not_converged,
                              contact::Status::cancelled};
constexpr std::array masses{contact::Mass::lumped, contact::Mass::consistent};
constexpr std::array sweep_cases{SweepSpec::Cases::combinations, SweepSpec::Cases::nodal_forces};

static void write(const fem::Force& force, Load& out) {
  if (const auto* constant = std::get_if<double>(&force)) {
    out.set_constant(*constant);
  } else if (const auto* expression = std::get_if<fem::Expression>(&force)) {
    out.set_expression(expression->text);
  } else if (const auto* regions = std::get_if<fem::PerRegion>(&force)) {
    write(regions->values, *out.mutable_per_region()->mutable_values());
  } else {
    const auto& array = std::get<fem::Array>(force);
    out.mutable_array()->set_upload(array.upload);
    out.mutable_array()->set_per_triangle(array.per_triangle);
  }
}

static fem::Force force_of(const Load& in) {
  switch (in.force_case()) {
    case Load::kConstant:
      return in.constant();
    case Load::kExpression:
      return fem::Expression{in.expression()};
    case Load::kPerRegion:
      return fem::PerRegion{read(in.per_region().values())};
    case Load::kArray:
      return fem::Array{in.array().upload(), in.array().per_triangle(), nullptr};
    case Load::FORCE_NOT_SET:
      break;
  }
  throw damaged_record("a load without a force");
}

static void write(const fem::PointForce& force, PointForce& out) {
  out.set_x(force.x);
  out.set_y(force.y);
  out.set_value(force.value);
}

static fem::PointForce read(const PointForce& in) {
  return {in.x(), in.y(), in.value()};
}

static void write(const fem::Load& load, Load& out) {
  out.set_name(load.name);
  write(load.force, out);
  out.set_boundary_value(load.boundary_value);
  out.set_traction(load.traction);
  write_all(load.point_forces, *out.mutable_point_forces());
  write(load.inclusion_forces, *out.mutable_inclusion_forces());
}

static fem::Load read(const Load& in) {
  return {in.name(),
          force_of(in),
          in.boundary_value(),
          in.traction(),
          read_all(in.point_forces()),
          read(in.inclusion_forces())};
}

static void write(const contact::UzawaOptions& options, Uzawa& out) {
  if (options.theta) {
    out.set_theta(*options.theta);
  }
  out.set_epsilon(options.epsilon);
  out.set_p(options.p);
  out.set_max_iterations(options.max_iterations);
  out.set_mass(number(masses, options.mass));
  if (options.kkt_tolerance) {
    out.set_kkt_tolerance(*options.kkt_tolerance);
  }
}

static contact::UzawaOptions read(const Uzawa& in) {
  contact::UzawaOptions options;
  options.theta = in.has_theta() ? std::optional(in.theta()) : std::nullopt;
  options.epsilon = in.epsilon();
  options.p = in.p();
  options.max_iterations = in.max_iterations();
  options.mass = choice(masses, in.mass());
  if (in.has_kkt_tolerance()) {
    options.kkt_tolerance = in.kkt_tolerance();
  }
  return options;
}

static contact::SolverOptions solver_of(const JobSpec& in) {
  switch (in.solver_case()) {
    case JobSpec::kActiveSet:
      return contact::ActiveSetOptions{in.active_set().tolerance(), in.active_set().max_steps()};
    case JobSpec::kUzawa:
      return read(in.uzawa());
    case JobSpec::SOLVER_NOT_SET:
      break;
  }
  throw damaged_record("a job without a solver");
}

static void write(const SweepSpec& sweep, Sweep& out) {
  out.set_cases(number(sweep_cases, sweep.cases));
  out.set_upload(sweep.upload);
  out.set_rows(sweep.rows);
  out.mutable_traces()->Assign(sweep.traces.begin(), sweep.traces.end());
}

static SweepSpec read(const Sweep& in) {
  return {choice(sweep_cases, in.cases()),
          in.upload(),
          in.rows(),
          {in.traces().begin(), in.traces().end()}};
}

static void write(const SweepRecord& sweep, SweepAnswer& out) {
  out.set_converged(sweep.converged);
  out.set_not_converged(sweep.not_converged);
  out.set_failed(sweep.failed);
  out.set_most_steps(sweep.most_steps);
  out.set_worst_kkt(sweep.worst_kkt);
  out.set_seconds(sweep.seconds);
  out.mutable_warnings()->Assign(sweep.warnings.begin(), sweep.warnings.end());
}

static SweepRecord read(const SweepAnswer& in) {
  return {in.converged(),
          in.not_converged(),
          in.failed(),
          in.most_steps(),
          in.worst_kkt(),
          in.seconds(),
          {in.warnings().begin(), in.warnings().end()}};
}

static void write(const store::JobSpec& spec, JobSpec& out) {
  out.set_title(spec.title);
  out.set_mesh(spec.mesh);
  write_all(spec.loads, *out.mutable_loads());
  if (const auto* active_set = std::get_if<contact::ActiveSetOptions>(&spec.solver)) {
    out.mutable_active_set()->set_tolerance(active_set->tolerance);
    out.mutable_active_set()->set_max_steps(active_set->max_steps);
  } else {
    write(std::get<contact::UzawaOptions>(spec.solver), *out.mutable_uzawa());
  }
  out.set_fields(spec.fields);
  if (spec.sweep) {
    write(*spec.sweep, *out.mutable_sweep());
  }
  out.set_priority(number(priorities, spec.priority));
  out.set_queue_time_limit_ms(spec.queue_time_limit.count());
  out.set_run_time_limit_ms(spec.run_time_limit.count());
}

static store::JobSpec read(const JobSpec& in) {
  store::JobSpec spec;
  spec.title = in.title();
  spec.mesh = in.mesh();
  spec.loads = read_all(in.loads());
  spec.solver = solver_of(in);
  spec.fields = in.fields();
  if (in.has_sweep()) {
    spec.sweep = read(in.sweep());
  }
  spec.priority = choice(priorities, in.priority());
  spec.queue_time_limit = milliseconds(in.queue_time_limit_ms());
  spec.run_time_limit = milliseconds(in.run_time_limit_ms());
  return spec;
}

static void write(const contact::KktResiduals& kkt, Kkt& out) {
  out.set_equilibrium(kkt.equilibrium);
  out.set_gap(kkt.gap);
  out.set_sign(kkt.sign);
  out.set_complementarity(kkt.complementarity);
}

static contact::KktResiduals read(const Kkt& in) {
  return {in.equilibrium(), in.gap(), in.sign(), in.complementarity()};
}

static void write(const contact::InclusionAnswer& inclusion, InclusionAnswer& out) {
  out.set_name(inclusion.name);
  out.set_displacement(inclusion.displacement);
  out.set_resultant(inclusion.resultant);
  out.set_contact_length(inclusion.contact_length);
}

static contact::InclusionAnswer read(const InclusionAnswer& in) {
  return {in.name(), in.displacement(), in.resultant(), in.contact_length()};
}

static void write(const contact::ContactInterval& interval, ContactInterval& out) {
  out.set_interface(interval.interface);
  out.set_begin(interval.begin);
  out.set_end(interval.end);
}

static contact::ContactInterval read(const ContactInterval& in) {
  return {in.interface(), in.begin(), in.end()};
}

static void write(const contact::Answer& answer, Answer& out) {
  out.set_status(number(statuses, answer.status));
  out.set_reason(answer.reason);
  out.set_iterations(answer.iterations);
  out.set_criterion(answer.criterion);
  out.set_theta(answer.theta);
  out.set_theta_star(answer.theta_star);
  out.set_energy(answer.energy);
  write(answer.kkt, *out.mutable_kkt());
  write(answer.kkt_relative, *out.mutable_kkt_relative());
  out.set_weakly_active(answer.weakly_active);
  write(answer.warnings, *out.mutable_warnings());
  write_all(answer.inclusions, *out.mutable_inclusions());
  out.set_contact_length(answer.contact_length);
  write_all(answer.contact_intervals, *out.mutable_contact_intervals());
}

static contact::Answer read(const Answer& in) {
  contact::Answer answer;
  answer.status = choice(statuses, in.status());
  answer.reason = in.reason();
  answer.iterations = in.iterations();
  answer.criterion = in.criterion();
  answer.theta = in.theta();
  answer.theta_star = in.theta_star();
  answer.energy = in.energy();
  answer.kkt = read(in.kkt());
  answer.kkt_relative = read(in.kkt_relative());
  answer.weakly_active = in.weakly_active();
  answer.warnings = read(in.warnings());
  answer.inclusions = read_all(in.inclusions());
  answer.contact_length = in.contact_length();
  answer.contact_intervals = read_all(in.contact_intervals());
  return answer;
}

static void write(const CaseRecord& record, Case& out) {
  out.set_status(number(case_statuses, record.status));
  if (record.error) {
    write(*record.error, *out.mutable_error());
  }
  write(record.answer, *out.mutable_answer());
  out.set_seconds(record.seconds);
}

static CaseRecord read(const Case& in) {
  CaseRecord record;
  record.status = choice(case_statuses, in.status());
  if (in.has_error()) {
    record.error = read(in.error());
  }
  record.answer = read(in.answer());
  record.seconds = in.seconds();
  return record;
}

static void write(const store::Step& step, Step& out) {
  out.set_time_ns(to_disk(step.time));
  out.set_state(number(job_states, step.state));
  out.set_detail(step.detail);
}

static store::Step read(const Step& in) {
  return {time_of(in.time_ns()), choice(job_states, in.state()), in.detail()};
}

}  // namespace anticrack::store::disk

namespace anticrack::store {

std::string encode(const JobRecord& record) {
  disk::JobRecord out;
  out.set_id(record.id);
  out.set_owner(record.owner);
  out.set_request_id(record.request_id);
  disk::write(record.spec, *out.mutable_spec());
  out.set_state(disk::number(disk::job_states, record.state));
  if (record.error) {
    disk::write(*record.error, *out.mutable_error());
  }
  out.set_created_ns(disk::to_disk(record.created));
  if (record.started) {
    out.set_started_ns(disk::to_disk(*record.started));
  }
  if (record.ended) {
    out.set_ended_ns(disk::to_disk(*record.ended));
  }
  disk::write_all(record.cases, *out.mutable_cases());
  disk::write(record.sweep, *out.mutable_sweep());
  out.set_result_bytes(record.result_bytes);
  out.set_attempt(record.attempt);
  disk::write_all(record.timeline, *out.mutable_timeline());
  return disk::serialized(out);
}

JobRecord decode_job_record(std::string_view bytes) {
  disk::JobRecord in;
  disk::parse(bytes, in);
  JobRecord record;
  record.id = in.id();
  record.owner = in.owner();
  record.request_id = in.request_id();
  record.spec = disk::read(in.spec());
  record.state = disk::choice(disk::job_states, in.state());
  if (in.has_error()) {
    record.error = disk::read(in.error());
  }
  record.created = disk::time_of(in.created_ns());
  if (in.has_started_ns()) {
    record.started = disk::time_of(in.started_ns());
  }
  if (in.has_ended_ns()) {
    record.ended = disk::time_of(in.ended_ns());
  }
  record.cases = disk::read_all(in.cases());
  record.sweep = disk::read(in.sweep());
  record.result_bytes = in.result_bytes();
  record.attempt = in.attempt();
  record.timeline = disk::read_all(in.timeline());
  return record;
}

}  // namespace anticrack::store
