// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/from_domain.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <variant>

#include "jobs/sample_run.hpp"
#include "rpc/error_table.hpp"
#include "rpc/from_sweep.hpp"
#include "rpc/names.hpp"
#include "rpc/text.hpp"

namespace anticrack::rpc {
namespace {

v1::LoadCaseAnswer::Status from_status(store::CaseStatus status) {
  switch (status) {
    case store::CaseStatus::pending:
      return v1::LoadCaseAnswer::STATUS_PENDING;
    case store::CaseStatus::running:
      return v1::LoadCaseAnswer::STATUS_RUNNING;
    case store::CaseStatus::converged:
      return v1::LoadCaseAnswer::STATUS_CONVERGED;
    case store::CaseStatus::not_converged:
      return v1::LoadCaseAnswer::STATUS_NOT_CONVERGED;
    case store::CaseStatus::failed:
      return v1::LoadCaseAnswer::STATUS_FAILED;
    case store::CaseStatus::cancelled:
      return v1::LoadCaseAnswer::STATUS_CANCELLED;
  }
  return v1::LoadCaseAnswer::STATUS_UNSPECIFIED;
}

v1::Force from_force(const fem::Force& force) {
  struct Visitor {
    v1::Force& to;
    void operator()(double constant) const { to.set_constant(constant); }
    void operator()(const fem::Expression& expression) const { to.set_expression(expression.text); }
    void operator()(const fem::PerRegion& regions) const {
      auto& values = *to.mutable_per_region()->mutable_values();
      for (const auto& [name, value] : regions.values) values[name] = value;
    }
    void operator()(const fem::Array& array) const {
      to.mutable_array()->set_upload(upload_name(array.upload));
      to.mutable_array()->set_per_triangle(array.per_triangle);
    }
  };
  v1::Force result;
  std::visit(Visitor{result}, force);
  return result;
}

v1::LoadCase from_load(const fem::Load& load) {
  v1::LoadCase to;
  to.set_name(load.name);
  *to.mutable_force() = from_force(load.force);
  to.set_boundary_value(load.boundary_value);
  to.set_traction(load.traction);
  for (const fem::PointForce& force : load.point_forces) {
    v1::PointForce& into = *to.add_point_forces();
    into.mutable_at()->set_x(force.x);
    into.mutable_at()->set_y(force.y);
    into.set_value(force.value);
  }
  for (const auto& [name, value] : load.inclusion_forces) {
    (*to.mutable_inclusion_forces())[name] = value;
  }
  return to;
}

v1::Solver from_solver(const contact::SolverOptions& options) {
  struct Visitor {
    v1::Solver& to;
    void operator()(const contact::UzawaOptions& from) const {
      v1::Uzawa& uzawa = *to.mutable_uzawa();
      if (from.theta) {
        uzawa.set_theta(*from.theta);
      } else {
        uzawa.set_theta_auto(true);
      }
      uzawa.set_epsilon(from.epsilon);
      uzawa.set_p(from.p);
      uzawa.set_max_iterations(from.max_iterations);
      uzawa.set_mass(from.mass == contact::Mass::lumped ? v1::MASS_LUMPED : v1::MASS_CONSISTENT);
      if (from.kkt_tolerance) uzawa.set_kkt_tolerance(*from.kkt_tolerance);
    }
    void operator()(const contact::ActiveSetOptions& from) const {
      to.mutable_active_set()->set_tolerance(from.tolerance);
      to.mutable_active_set()->set_max_steps(from.max_steps);
    }
  };
  v1::Solver solver;
  std::visit(Visitor{solver}, options);
  return solver;
}

void set_kkt(const contact::Answer& answer, v1::KktResiduals& to) {
  to.set_equilibrium(answer.kkt.equilibrium);
  to.set_gap(answer.kkt.gap);
  to.set_sign(answer.kkt.sign);
  to.set_complementarity(answer.kkt.complementarity);
  to.set_equilibrium_relative(answer.kkt_relative.equilibrium);
  to.set_gap_relative(answer.kkt_relative.gap);
  to.set_sign_relative(answer.kkt_relative.sign);
  to.set_complementarity_relative(answer.kkt_relative.complementarity);
}

v1::Job::Priority from_priority(store::Priority priority) {
  switch (priority) {
    case store::Priority::interactive:
      return v1::Job::PRIORITY_INTERACTIVE;
    case store::Priority::normal:
      return v1::Job::PRIORITY_NORMAL;
    case store::Priority::bulk:
      return v1::Job::PRIORITY_BULK;
  }
  return v1::Job::PRIORITY_UNSPECIFIED;
}

/// A job that is queued again was started once more, by the next start of the server.
void add_timeline(const store::JobRecord& record, v1::Job& to) {
  int attempt = 1;
  for (const store::Step& step : record.timeline) {
    const bool first = to.timeline().empty();
    if (!first && step.state == store::JobState::queued &&
        to.timeline().rbegin()->state() != v1::Job::STATE_QUEUED) {
      attempt = std::min(attempt + 1, record.attempt);
    }
    v1::Job::Step& into = *to.add_timeline();
    *into.mutable_time() = to_timestamp(step.time);
    into.set_state(from_domain(step.state));
    into.set_detail(printable(step.detail, 200));
    into.set_attempt(attempt);
  }
}

v1::ArrayLayout::Type from_type(store::ArrayType type) {
  switch (type) {
    case store::ArrayType::float64:
      return v1::ArrayLayout::TYPE_FLOAT64;
    case store::ArrayType::int32:
      return v1::ArrayLayout::TYPE_INT32;
    case store::ArrayType::uint8:
      return v1::ArrayLayout::TYPE_UINT8;
  }
  return v1::ArrayLayout::TYPE_UNSPECIFIED;
}

bool has_answer(store::CaseStatus status) {
  return status == store::CaseStatus::converged || status == store::CaseStatus::not_converged ||
         status == store::CaseStatus::cancelled;
}

}  // namespace

v1::Job::State from_domain(store::JobState state) noexcept {
  switch (state) {
    case store::JobState::queued:
      return v1::Job::STATE_QUEUED;
    case store::JobState::waiting_for_mesh:
      return v1::Job::STATE_WAITING_FOR_MESH;
    case store::JobState::running:
      return v1::Job::STATE_RUNNING;
    case store::JobState::succeeded:
      return v1::Job::STATE_SUCCEEDED;
    case store::JobState::failed:
      return v1::Job::STATE_FAILED;
    case store::JobState::cancelled:
      return v1::Job::STATE_CANCELLED;
    case store::JobState::expired:
      return v1::Job::STATE_EXPIRED;
  }
  return v1::Job::STATE_UNSPECIFIED;
}

v1::LoadCaseAnswer from_domain(const store::CaseRecord& record, const std::string& name,
                               const InterfaceNames& interfaces) {
  v1::LoadCaseAnswer to;
  to.set_name(name);
  to.set_status(from_status(record.status));
  if (record.error) *to.mutable_error() = to_message(*record.error);
  if (!has_answer(record.status)) return to;
  const contact::Answer& answer = record.answer;
  to.set_reason(answer.reason);
  to.set_iterations(answer.iterations);
  to.set_criterion(answer.criterion);
  to.set_theta(answer.theta);
  to.set_theta_star(answer.theta_star);
  to.set_energy(answer.energy);
  set_kkt(answer, *to.mutable_kkt());
  to.set_weakly_active(answer.weakly_active);
  for (const std::string& warning : answer.warnings) to.add_warnings(printable(warning, 500));
  for (const contact::InclusionAnswer& inclusion : answer.inclusions) {
    v1::InclusionAnswer& into = *to.add_inclusions();
    into.set_name(inclusion.name);
    into.set_displacement(inclusion.displacement);
    into.set_resultant(inclusion.resultant);
    into.set_contact_length(inclusion.contact_length);
  }
  to.set_contact_length(answer.contact_length);
  for (const contact::ContactInterval& interval : answer.contact_intervals) {
    v1::ContactInterval& into = *to.add_contact_intervals();
    if (interval.interface < interfaces.size()) into.set_interface(interfaces[interval.interface]);
    into.set_begin(interval.begin);
    into.set_end(interval.end);
  }
  *to.mutable_solve_time() = to_duration(std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(record.seconds)));
  return to;
}

v1::Job from_domain(const store::JobRecord& record, const InterfaceNames& interfaces) {
  v1::Job job;
  job.set_title(record.spec.title);
  job.set_mesh(mesh_name(record.spec.mesh));
  for (const fem::Load& load : record.spec.loads) {
    *job.add_load_cases() = from_load(load);
  }
  *job.mutable_solver() = from_solver(record.spec.solver);
  job.set_fields(record.spec.fields);
  job.set_priority(from_priority(record.spec.priority));
  if (record.spec.queue_time_limit.count() > 0) {
    *job.mutable_queue_timeout() = to_duration(record.spec.queue_time_limit);
  }
  if (record.spec.run_time_limit.count() > 0) {
    *job.mutable_run_timeout() = to_duration(record.spec.run_time_limit);
  }
  job.set_name(job_name(record.id));
  job.set_state(from_domain(record.state));
  if (record.error) *job.mutable_error() = to_message(*record.error);
  *job.mutable_create_time() = to_timestamp(record.created);
  if (record.started) *job.mutable_start_time() = to_timestamp(*record.started);
  if (record.ended) *job.mutable_end_time() = to_timestamp(*record.ended);
  for (std::size_t i = 0; i < record.cases.size() && i < record.spec.loads.size(); ++i) {
    *job.add_answers() = from_domain(record.cases[i], record.spec.loads[i].name, interfaces);
  }
  if (record.spec.sweep) {
    *job.mutable_sweep() = from_domain(*record.spec.sweep);
    *job.mutable_sweep_answer() = from_domain(*record.spec.sweep, record.sweep);
  }
  job.set_result_bytes(record.result_bytes);
  job.set_attempt(record.attempt);
  job.set_owner(record.owner);
  add_timeline(record, job);
  if (job.ByteSizeLong() > max_job_message_bytes) {
    for (v1::LoadCaseAnswer& answer : *job.mutable_answers()) answer.clear_contact_intervals();
  }
  return job;
}

v1::BlockLayout layout_of(const store::BlockSource& block) {
  v1::BlockLayout layout;
  layout.set_size(block.size());
  layout.set_sha256(block.sha256());
  for (const store::ArrayLayout& array : block.arrays()) {
    v1::ArrayLayout& to = *layout.add_arrays();
    to.set_name(array.name);
    to.set_type(from_type(array.type));
    to.mutable_shape()->Add(array.shape.begin(), array.shape.end());
    to.set_offset(array.offset);
  }
  return layout;
}

void append(v1::Samples& samples, const std::vector<jobs::SampleRun>& runs) {
  using jobs::SamplePage;
  const auto column = [&runs]<class T>(google::protobuf::RepeatedField<T>& to,
                                       SamplePage::Column<T> SamplePage::*from) {
    std::size_t count = static_cast<std::size_t>(to.size());
    for (const jobs::SampleRun& run : runs) count += run.count;
    to.Reserve(static_cast<int>(count));
    for (const jobs::SampleRun& run : runs) {
      const std::span<const T> values = run.column(from);
      to.Add(values.begin(), values.end());
    }
  };
  column(*samples.mutable_load_case(), &SamplePage::load_case);
  column(*samples.mutable_iteration(), &SamplePage::iteration);
  column(*samples.mutable_criterion(), &SamplePage::criterion);
  column(*samples.mutable_energy(), &SamplePage::energy);
  column(*samples.mutable_contact_count(), &SamplePage::contact_count);
  column(*samples.mutable_kkt_gap(), &SamplePage::gap);
  column(*samples.mutable_kkt_sign(), &SamplePage::sign);
  column(*samples.mutable_kkt_complementarity(), &SamplePage::complementarity);
  column(*samples.mutable_kkt_equilibrium(), &SamplePage::equilibrium);
}

google::protobuf::Duration to_duration(std::chrono::nanoseconds duration) {
  google::protobuf::Duration to;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(duration);
  to.set_seconds(seconds.count());
  to.set_nanos(static_cast<std::int32_t>((duration - seconds).count()));
  return to;
}

google::protobuf::Timestamp to_timestamp(store::Clock::time_point time) {
  google::protobuf::Timestamp to;
  const auto since = std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  to.set_seconds(seconds.count());
  to.set_nanos(static_cast<std::int32_t>((since - seconds).count()));
  return to;
}

}  // namespace anticrack::rpc
