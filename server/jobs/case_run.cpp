// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/case_run.hpp"

#include <chrono>
#include <new>
#include <utility>

#include "errors/errors.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using store::CaseStatus;

class Recorder final : public contact::Observer {
 public:
  Recorder(std::size_t load_case, EventLog& log, const std::stop_token& stop,
           std::atomic<std::uint64_t>& iterations)
      : _load_case(static_cast<std::int32_t>(load_case)),
        _log(log),
        _stop(stop),
        _iterations(iterations) {}

  bool on_iteration(const contact::Sample& sample) override {
    history.push_back(sample);
    _log.append(SampleEvent{_load_case, sample});
    _iterations.fetch_add(1, std::memory_order_relaxed);
    return !_stop.stop_requested();
  }

  std::vector<contact::Sample> history;

 private:
  std::int32_t _load_case;
  EventLog& _log;
  const std::stop_token& _stop;
  std::atomic<std::uint64_t>& _iterations;
};

CaseStatus status_of(contact::Status status) {
  switch (status) {
    case contact::Status::converged:
      return CaseStatus::converged;
    case contact::Status::not_converged:
      return CaseStatus::not_converged;
    case contact::Status::cancelled:
      return CaseStatus::cancelled;
  }
  return CaseStatus::failed;
}

contact::Answer without_arrays(const contact::Answer& answer) {
  contact::Answer result;
  result.status = answer.status;
  result.reason = answer.reason;
  result.iterations = answer.iterations;
  result.criterion = answer.criterion;
  result.theta = answer.theta;
  result.theta_star = answer.theta_star;
  result.energy = answer.energy;
  result.kkt = answer.kkt;
  result.kkt_relative = answer.kkt_relative;
  result.weakly_active = answer.weakly_active;
  result.warnings = answer.warnings;
  result.inclusions = answer.inclusions;
  result.contact_length = answer.contact_length;
  result.contact_intervals = answer.contact_intervals;
  return result;
}

/// The error with its place in the job: always a field, so that a client can point at the case, or
/// at the method that cannot solve on this mesh.
Error placed(Error error, std::size_t index) {
  const std::string path = "load_cases[" + std::to_string(index) + "]";
  if (error.fields().empty()) {
    error.at(path);
  } else if (error.fields().front().field == "uzawa") {
    error.below("solver");
  } else {
    error.below(path);
  }
  return error;
}

}  // namespace

std::uint64_t bytes_of(const SolvedCase& solved) {
  std::uint64_t bytes = solved.history.size() * sizeof(contact::Sample);
  for (const contact::Trace& trace : solved.answer.traces) {
    bytes += trace.jump.size() * (4 * sizeof(double) + sizeof(std::int32_t));
  }
  for (const contact::Field& field : solved.answer.fields) {
    bytes += field.u.size() * (sizeof(double) + sizeof(std::int32_t));
  }
  return bytes;
}

CaseOutcome refuse_case(std::size_t index, std::uint64_t max_result_bytes) {
  auto record = std::make_shared<store::CaseRecord>();
  record->status = CaseStatus::failed;
  record->error = placed(
      Error(Reason::limit_exceeded, "the results of the load cases before are over " +
                                        std::to_string(max_result_bytes) +
                                        " bytes, the limit of a job: split the job, or leave its "
                                        "fields out"),
      index);
  return {std::move(record), nullptr};
}

CaseOutcome run_case(LiveJob& job, std::size_t index, const store::Store& store,
                     std::atomic<std::uint64_t>& iterations) {
  const auto start = std::chrono::steady_clock::now();
  auto record = std::make_shared<store::CaseRecord>();
  std::unique_ptr<SolvedCase> solved;
  record->status = CaseStatus::failed;
  try {
    const store::JobSpec& spec = *job.spec;
    const std::stop_token stop = job.stop.get_token();
    Recorder recorder(index, *job.log, stop, iterations);
    contact::Answer answer = job.mesh_operator->solve(job.arrays.resolve(spec.loads[index], store),
                                                      spec.solver, spec.fields, recorder, stop);
    record->answer = without_arrays(answer);
    record->status = status_of(answer.status);
    if (record->status != CaseStatus::cancelled) {
      solved =
          std::make_unique<SolvedCase>(SolvedCase{std::move(answer), std::move(recorder.history)});
    }
  } catch (const Error& error) {
    if (error.reason() == Reason::cancelled) {
      record->status = CaseStatus::cancelled;
    } else {
      record->error = placed(error, index);
    }
  } catch (const std::bad_alloc&) {
    record->error =
        placed(Error(Reason::limit_exceeded, "not enough memory for this load case"), index);
  } catch (const std::exception& error) {
    record->error =
        placed(Error(Reason::internal, std::string("solving failed: ") + error.what()), index);
  }
  record->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {std::move(record), std::move(solved)};
}

}  // namespace anticrack::jobs
