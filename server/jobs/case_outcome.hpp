// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a load case ended, and the observers while it iterates.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <vector>

#include "contact/observer.hpp"
#include "jobs/live_job.hpp"
#include "store/store.hpp"

namespace anticrack::contact {
struct Answer;
}  // namespace anticrack::contact
namespace anticrack::operators {
class MeshOperator;
class PreparedLoad;
}  // namespace anticrack::operators

namespace anticrack::jobs {

struct CaseOutcome {
  std::shared_ptr<const records::CaseRecord> record;
  std::optional<ResultPart> result{};  ///< only if converged or not_converged
  std::vector<double> indicator{};     ///< (triangles), only for a job with an accuracy
};

/// A load case that has ended; a thread reports it after its work without the lock.
struct EndedCase {
  Task task;
  CaseOutcome outcome;
};

/// Keeps a load case's history, and stops the case when its job must stop. One object belongs to
/// the thread that solves.
class History : public contact::Observer {
 public:
  /// Adds every iteration to `iterations`, which must outlive this object.
  History(const Task& task, std::atomic<std::uint64_t>& iterations);
  bool on_iteration(const contact::Sample& sample) override;
  /// To be called when the load case has ended for its job: no more samples are kept.
  void give_up() noexcept { _given_up = true; }
  const std::vector<contact::Sample>& history() const noexcept { return _samples; }

  EventLog& log() const noexcept { return *_log; }
  std::int32_t load_case() const noexcept { return _load_case; }
  /// Appends the samples that came since the last call.
  void append_new(std::vector<SampleEvent>& to);

 private:
  const std::int32_t _load_case;
  const std::shared_ptr<EventLog> _log;
  const std::stop_token _stop;
  std::atomic<std::uint64_t>& _iterations;
  std::vector<contact::Sample> _samples;
  std::size_t _appended = 0;
  bool _given_up = false;
};

/// A history that also appends each sample to its job's log.
class Recorder final : public History {
 public:
  using History::History;
  bool on_iteration(const contact::Sample& sample) override;
};

/// The end of a load case that was solved or stopped. `history`: its iterations. The arrays of the
/// answer go into the job's spool.
CaseOutcome solved_case(const Task& task, const contact::Answer& answer,
                        const std::vector<contact::Sample>& history,
                        std::vector<double> indicator = {},
                        const std::vector<double>& balanced_flux = {});
/// Solves a load by the active set, without a history. Throws errors::Error (cancelled) if the job
/// is to stop.
contact::Answer solve_quietly(const LiveJob& job, const operators::MeshOperator& on,
                              const operators::PreparedLoad& load);
/// Prepares a load. Throws the errors::Error that it gets from MeshOperator::prepare().
operators::PreparedLoad prepare_one(const LiveJob& job, const operators::MeshOperator& on,
                                    const fem::Load& load);

/// Any exception as an error.
errors::Error error_of(const std::exception_ptr& failure);

/// The end of a load case whose solution threw: cancelled if it was stopped, else failed with the
/// error. The error's field is that in the job ("load_cases[i]...", or "solver.uzawa" if the method
/// cannot solve on this mesh).
CaseOutcome failed_case(const Task& task, const std::exception_ptr& failure);
/// The end of a load case whose job's result has no room for more.
CaseOutcome refused_case(const Task& task, std::uint64_t max_result_bytes);
CaseOutcome cancelled_case(const Task& task);

}  // namespace anticrack::jobs
