// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/ending_thread.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "errors/errors.hpp"
#include "fields/walk.hpp"
#include "jobs/event_rows.hpp"
#include "jobs/result_block.hpp"
#include "jobs/sweep_result.hpp"
#include "records/case_record.hpp"
#include "stop/stop.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using records::JobState;

constexpr std::chrono::milliseconds retry_write{1'000};
constexpr const char* writing = "writing the result";

/// Whether the error comes from the disk, so that the same call may succeed later.
bool is_of_the_disk(const Error& error) {
  return error.reason() == Reason::disk_full || error.reason() == Reason::storage;
}

Error lost(const std::exception& exception) {
  if (dynamic_cast<const std::bad_alloc*>(&exception) != nullptr) {
    return {Reason::limit_exceeded,
            "not enough memory for the result: split the job, or leave its fields out"};
  }
  const auto* error = dynamic_cast<const Error*>(&exception);
  return {error ? error->reason() : Reason::internal,
          std::string("the result was lost: ") + exception.what()};
}

void set_state(records::JobRecord& record, JobState state, const std::optional<Error>& error) {
  record.state = state;
  record.error = error;
  record.timeline.back().state = state;
}

}  // namespace

void EndingThread::End::fail(const std::exception& why) {
  const auto* error = dynamic_cast<const Error*>(&why);
  if (error != nullptr && error->reason() == Reason::cancelled)
    without_result(JobState::cancelled);
  else
    without_result(JobState::failed, lost(why));
}

void EndingThread::End::without_result(JobState state, const std::optional<Error>& error) {
  set_state(record, state, error);
  record.result_bytes = 0;
  result.reset();
}

EndingThread::EndingThread(EngineCore& core)
    : _core(core), _thread(core.start([this] { work(); })) {}

void EndingThread::work() {
  Lock lock(_core.mutex);
  while (!_core.quitting) {
    if (!_core.to_end.empty()) {
      const JobPtr job = _core.to_end.pop();
      lock.unlock();
      write(conclude_job(job));
      lock.lock();
    } else if (std::optional<End> end = next_waiting()) {
      lock.unlock();
      write(std::move(*end));
      lock.lock();
    } else if (_waiting.empty()) {
      _core.ending.wait(lock);
    } else {
      _core.ending.wait_until(lock,
                              std::ranges::min_element(_waiting, {}, &End::next_try)->next_try);
    }
  }
}

EndingThread::End EndingThread::conclude_job(const JobPtr& job) {
  Lock lock(_core.mutex);
  const Outcome outcome = conclude(*job);
  const bool stopped = job->why != Stop::none;  // its answers are written even if it is stopped
                                                // again
  if (job->started) add_step(job->timeline, JobState::running, writing);
  End end{job, {}, nullptr, stopped ? std::stop_token() : job->writing.get_token()};
  const JobSnapshot snapshot(*job);
  lock.unlock();
  end.record = snapshot.record();
  end.record.ended = records::Clock::now();
  add_step(end.record.timeline, outcome.state, {});
  set_state(end.record, outcome.state, outcome.error);
  try {
    const stop::Scope scope(end.stop);
    if (job->sweep) {
      const auto unsolved =
          outcome.state == JobState::failed ? contact::Status::failed : contact::Status::cancelled;
      end.result = sweep_result(*job, unsolved);
    } else if (job->stages && job->stages->last.result) {
      end.result = std::move(job->stages->last.result);
    } else if (job->mesh_operator) {
      end.result = result_block(*job);
    }
    end.record.result_bytes = end.result ? end.result->size() : 0;
  } catch (const std::exception& exception) {
    end.fail(exception);
  }
  job->mesh_operator.reset();  // released before the writing, which may take long
  job->spool.reset();
  if (job->sweep) {
    job->sweep->basis.reset();
    job->sweep->chunks.clear();
  }
  return end;
}

void EndingThread::write(End end) {
  const JobPtr job = end.job;
  Lock lock(_core.mutex);
  if (job->phase == Phase::refused && job->why == Stop::cancelled)
    end.without_result(JobState::cancelled);
  lock.unlock();
  if (finish(end)) return announce(end);
  lock.lock();
  if (end.taken || _core.interrupting) return leave_to_next_start(end);
  end.next_try = Clock::now() + retry_write;
  _waiting.push_back(std::move(end));
  if (job->phase == Phase::refused) return;
  job->enter(Phase::refused);
  const PhaseEvent event{job->state(), writing};
  lock.unlock();
  job->log->append(event);
}

bool EndingThread::finish(End& end) {
  try {
    const stop::Scope scope(end.result ? end.stop : std::stop_token());
    if (_core.rows) _core.rows->publish({end.job});
    _core.store.finish(end.record, end.result);
    return true;
  } catch (const std::bad_alloc&) {
    return false;  // treated like a disk that refuses
  } catch (const store::JobTaken&) {
    end.taken = true;
    return false;
  } catch (const std::exception& exception) {
    const auto* error = dynamic_cast<const Error*>(&exception);
    if (!end.result || (error && is_of_the_disk(*error))) return false;
    end.fail(exception);  // a later try would fail as well
    return finish(end);
  }
}

void EndingThread::announce(const End& end) {
  const JobPtr& job = end.job;
  const auto record = std::make_shared<const records::JobRecord>(end.record);
  const std::uint64_t log_bytes = job->log->bytes() + fields::bytes_of(*record);
  if (_core.options.ended) _core.options.ended(*record);
  job->mesh_use.reset();
  if (job->stages) forget_meshes(*job);
  Lock lock(_core.mutex);
  _core.running -= job->started ? 1 : 0;
  job->enter(Phase::over);
  _core.retention.add({job->id(), *record->ended, record->result_bytes, record->owner});
  _core.ended_since_sweep = true;
  _core.sweeping.notify_one();
  _core.logs.add(job->id(), job->log, log_bytes);
  if (_core.jobs.at(job->id()) == job) _core.jobs.erase(job->id());
  _core.admission.ended(job->created.owner, job->spec_bytes);
  ++_core.ended;  // before the end event, so that watchers find the job counted
  lock.unlock();
  job->log->append(EndEvent{record});
  lock.lock();
  --_core.not_announced;
  _core.settled.notify_all();
  _core.queue_changed = true;
  _core.claiming.notify_all();
}

void EndingThread::forget_meshes(const LiveJob& job) {
  LiveStages& stages = *job.stages;
  stages.mesh_use.reset();
  for (const std::string& mesh : stages.made) {
    if (job.spec->accuracy->keep_stages || mesh == stages.records.back().mesh) continue;
    try {
      _core.catalogue.erase(mesh);
    } catch (const std::exception&) {
      // The mesh stays among those of the owner, who may delete it.
    }
  }
}

void EndingThread::leave_to_next_start(const End& end) {
  _core.running -= end.job->started ? 1 : 0;
  end.job->enter(Phase::over);
  _core.admission.ended(end.job->created.owner, end.job->spec_bytes);
  --_core.not_announced;
  _core.settled.notify_all();
  _core.give_up(end.job);
}

std::optional<EndingThread::End> EndingThread::next_waiting() {
  if (_core.interrupting)
    for (const End& end : std::exchange(_waiting, {})) leave_to_next_start(end);
  const auto now = Clock::now();
  const auto due = std::find_if(_waiting.begin(), _waiting.end(), [&](const End& end) {
    const bool cancelled =
        end.job->why == Stop::cancelled && end.record.state != JobState::cancelled;
    return cancelled || end.next_try <= now;
  });
  if (due == _waiting.end()) return std::nullopt;
  End end = std::move(*due);
  _waiting.erase(due);
  return end;
}

}  // namespace anticrack::jobs
