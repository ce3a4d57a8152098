// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/case_outcome.hpp"

#include <fmt/core.h>

#include <chrono>
#include <new>
#include <string>
#include <utility>
#include <variant>

#include "errors/errors.hpp"
#include "jobs/result_block.hpp"
#include "operators/mesh_operator.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {

namespace {

using contact::Status;
using errors::Error;
using errors::Reason;

Error placed(Error error, std::size_t index) {
  const std::string path = fmt::format("load_cases[{}]", index);
  if (error.fields().empty())
    error.at(path);
  else if (error.fields().front().field == "uzawa")
    error.below("solver");
  else if (!error.fields().front().field.starts_with("growth"))
    error.below(path);
  return error;
}

class UntilStopped final : public contact::Observer {
 public:
  explicit UntilStopped(std::stop_token stop) : _stop(std::move(stop)) {}
  bool on_iteration(const contact::Sample& /*sample*/) override { return !_stop.stop_requested(); }

 private:
  const std::stop_token _stop;
};

std::shared_ptr<records::CaseRecord> new_record(const Task& task, Status status) {
  auto record = std::make_shared<records::CaseRecord>();
  record->status = status;
  record->solve_time = std::chrono::steady_clock::now() - task.taken;
  return record;
}

}  // namespace

History::History(const Task& task, std::atomic<std::uint64_t>& iterations)
    : _load_case(static_cast<std::int32_t>(task.index)),
      _log(task.job->log),
      _stop(task.job->stop.get_token()),
      _iterations(iterations) {}

bool History::on_iteration(const contact::Sample& sample) {
  if (_given_up) return false;
  _samples.push_back(sample);
  _iterations.fetch_add(1, std::memory_order_relaxed);
  return !_stop.stop_requested();
}

void History::append_new(std::vector<SampleEvent>& to) {
  for (; _appended < _samples.size(); ++_appended) to.push_back({_load_case, _samples[_appended]});
}

bool Recorder::on_iteration(const contact::Sample& sample) {
  log().append(SampleEvent{load_case(), sample});
  return History::on_iteration(sample);
}

Error error_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return {Reason::limit_exceeded, "not enough memory to solve it: submit less at a time"};
  } catch (const std::exception& error) {
    return {Reason::internal, std::string("solving failed: ") + error.what()};
  }
}

contact::Answer solve_quietly(const LiveJob& job, const operators::MeshOperator& on,
                              const operators::PreparedLoad& load) {
  UntilStopped observer(job.stop.get_token());
  contact::Answer answer =
      on.solve(load, std::get<contact::ActiveSetOptions>(job.spec->solver), false, observer);
  if (answer.status == Status::cancelled) throw Error(Reason::cancelled, "the job was stopped");
  return answer;
}

operators::PreparedLoad prepare_one(const LiveJob& job, const operators::MeshOperator& on,
                                    const fem::Load& load) {
  const fem::Load* const one[] = {&load};
  auto outcome = std::move(on.prepare(one, job.stop.get_token()).front());
  if (const auto* error = std::get_if<Error>(&outcome)) throw Error(*error);
  return std::get<operators::PreparedLoad>(std::move(outcome));
}

CaseOutcome solved_case(const Task& task, const contact::Answer& answer,
                        const std::vector<contact::Sample>& history, std::vector<double> indicator,
                        const std::vector<double>& balanced_flux) {
  auto record = new_record(task, answer.status);
  record->answer = answer;  // only the summary, without the arrays
  CaseOutcome outcome{std::move(record)};
  if (answer.status != Status::cancelled)
    outcome.result = spooled(
        *task.job->spool,
        case_arrays(task.index, answer, history,
                    task.job->spec->indicators ? indicator : std::vector<double>(), balanced_flux));
  if (task.job->stages) outcome.indicator = std::move(indicator);
  return outcome;
}

CaseOutcome failed_case(const Task& task, const std::exception_ptr& failure) {
  const Error error = error_of(failure);
  if (error.reason() == Reason::cancelled) return cancelled_case(task);
  auto record = new_record(task, Status::failed);
  record->error = placed(error, task.index);
  return {std::move(record)};
}

CaseOutcome refused_case(const Task& task, std::uint64_t max_result_bytes) {
  auto record = new_record(task, Status::failed);
  record->error = placed(Error(Reason::limit_exceeded,
                               "the results of the load cases before are over {} bytes, the limit "
                               "of a job: split the job, or leave its fields out",
                               max_result_bytes),
                         task.index);
  return {std::move(record)};
}

CaseOutcome cancelled_case(const Task& task) { return {new_record(task, Status::cancelled)}; }

}  // namespace anticrack::jobs
