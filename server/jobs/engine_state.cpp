// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/engine_state.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "jobs/case_run.hpp"
#include "jobs/result_block.hpp"
#include "jobs/retention.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using store::CaseRecord;
using store::CaseStatus;
using store::JobState;
using store::MeshState;
using Steady = std::chrono::steady_clock;

constexpr int preparation_threads = 2;
constexpr std::size_t prepared_limit = 3;
/// How often an idle solver thread looks for meshes that became ready without this engine's doing.
constexpr std::chrono::milliseconds poll_interval{100};

std::string detail_of(MeshState state) {
  switch (state) {
    case MeshState::pending:
      return "waiting for the mesher";
    case MeshState::meshing:
      return "meshing";
    default:
      return "factorising";
  }
}

}  // namespace

JobEngine::State::State(EngineOptions engine_options, store::Store& records,
                        meshes::MeshCatalogue& meshes)
    : options(engine_options), store(records), catalogue(meshes), queue(prepared_limit) {
  for (int i = 0; i < preparation_threads; ++i) {
    threads.emplace_back([this] { prepare_jobs(); });
  }
  for (int i = 0; i < std::max(1, options.threads); ++i) {
    threads.emplace_back([this] { solve_cases(); });
  }
}

JobEngine::State::~State() {
  {
    const std::lock_guard lock(mutex);
    quitting = true;
  }
  changed.notify_all();
  for (std::thread& thread : threads) {
    thread.join();
  }
}

void JobEngine::State::prepare_jobs() {
  Lock lock(mutex);
  while (!quitting) {
    const auto now = Steady::now();
    if (const JobPtr job = queue.next_to_prepare(now)) {
      lock.unlock();
      prepare(job);
      lock.lock();
    } else if (const auto retry = queue.next_retry(now)) {
      changed.wait_until(lock, *retry);
    } else {
      changed.wait(lock);
    }
  }
}

void JobEngine::State::prepare(const JobPtr& job) {
  // A job that waits for memory is tried every second, perhaps for hours: that is told once.
  const bool retry = job->not_before != Steady::time_point();
  const auto tell = [&](MeshState state) {
    {
      const std::lock_guard lock(mutex);
      job->state = JobState::waiting_for_mesh;
    }
    if (retry) {
      return;
    }
    job->log->append(PhaseEvent{JobState::waiting_for_mesh, detail_of(state)});
  };
  JobQueue::Operator mesh_operator;
  std::optional<Error> failure;
  try {
    mesh_operator = catalogue.prepare(job->spec->mesh, tell, job->stop.get_token());
  } catch (const Error& error) {
    failure = error;
  } catch (const std::exception& error) {
    failure = Error(Reason::internal, error.what());
  }
  const bool busy = failure && failure->reason() == Reason::busy;
  if (busy && !retry) {
    job->log->append(PhaseEvent{JobState::waiting_for_mesh, "waiting for memory to factorise"});
  }

  Lock lock(mutex);
  changed.notify_all();
  const bool stopped =
      job->stop.stop_requested() || (failure && failure->reason() == Reason::cancelled);
  if (!stopped && mesh_operator) {
    job->mesh_operator = std::move(mesh_operator);
    queue.prepared(job);
    return;
  }
  if (!stopped && busy) {
    queue.prepare_again(job, Steady::now() + failure->retry_delay());
    return;
  }
  queue.drop(*job);
  job->ending = true;
  lock.unlock();
  end(job, stopped ? std::nullopt : std::optional<Error>(mesh_failed(job->spec->mesh, *failure)));
}

void JobEngine::State::solve_cases() {
  const auto find = [this](const std::string& mesh) { return catalogue.find(mesh); };
  Lock lock(mutex);
  while (!quitting) {
    if (!finished.empty()) {
      const JobPtr job = std::move(finished.front());
      finished.pop_front();
      lock.unlock();
      end(job, std::nullopt);
      lock.lock();
    } else if (!runnable.empty()) {
      solve_next_case(lock);
    } else if (const JobPtr job = queue.next_to_start(find)) {
      start(lock, job);
    } else if (queue.waiting() > 0) {
      changed.wait_for(lock, poll_interval);
    } else {
      changed.wait(lock);
    }
  }
}

void JobEngine::State::start(Lock& lock, const JobPtr& job) {
  job->state = JobState::running;
  job->started = store::Clock::now();
  ++running;
  ++job->active;  // nobody else ends it before its first event is out
  lock.unlock();
  job->log->append(PhaseEvent{JobState::running, {}});
  lock.lock();
  --job->active;
  if (job->next_case < job->cases.size()) {  // else it was cancelled meanwhile
    runnable.push_back(job);
  }
  settle(job);
  changed.notify_all();
}

void JobEngine::State::solve_next_case(Lock& lock) {
  const JobPtr job = runnable.front();
  const std::size_t index = job->next_case++;
  if (job->next_case == job->cases.size()) {
    runnable.pop_front();
  }
  ++job->active;
  job->cases[index].running = true;
  const bool refused = job->result_bytes > options.max_result_bytes;
  lock.unlock();
  CaseOutcome outcome = refused ? refuse_case(index, options.max_result_bytes)
                                : run_case(*job, index, store, iterations);
  job->log->append(CaseEvent{static_cast<std::int32_t>(index), outcome.record});
  lock.lock();
  LiveCase& live = job->cases[index];
  live.running = false;
  live.record = std::move(outcome.record);
  live.solved = std::move(outcome.solved);
  job->result_bytes += live.solved ? bytes_of(*live.solved) : 0;
  ++cases_ended;
  --job->active;
  settle(job);
}

void JobEngine::State::settle(const JobPtr& job) {
  if (job->stop.stop_requested() && job->next_case < job->cases.size()) {
    job->next_case = job->cases.size();
    runnable.erase(std::remove(runnable.begin(), runnable.end(), job), runnable.end());
  }
  if (!job->ending && job->active == 0 && job->next_case == job->cases.size()) {
    job->ending = true;
    finished.push_back(job);
    changed.notify_all();
  }
}

void JobEngine::State::cancel(const JobPtr& job) {
  job->stop.request_stop();
  Lock lock(mutex);
  if (queue.remove(*job)) {
    job->ending = true;
    lock.unlock();
    end(job, std::nullopt);
  } else if (job->state == JobState::running && !job->ending) {
    settle(job);
  }
}

void JobEngine::State::end(const JobPtr& job, const std::optional<Error>& failure) {
  const auto never_ran = std::make_shared<CaseRecord>();
  never_ran->status = failure ? CaseStatus::failed : CaseStatus::cancelled;
  never_ran->error = failure;
  Lock lock(mutex);
  for (LiveCase& live : job->cases) {
    if (!live.record) {
      live.record = never_ran;
    }
  }
  const JobSnapshot snapshot(*job);
  lock.unlock();

  auto record = std::make_shared<store::JobRecord>(snapshot.record());
  const Outcome result =
      failure ? Outcome{JobState::failed, failure} : outcome(*job->spec, job->cases);
  record->state = result.state;
  record->error = result.error;
  record->ended = store::Clock::now();
  try {
    if (const auto block =
            job->mesh_operator ? result_block(*job->mesh_operator, job->cases) : nullptr) {
      record->result_bytes = block->bytes.size();
      store.put_result(job->id, block);
    }
    store.put(*record);
  } catch (const std::exception& error) {
    record->state = JobState::failed;
    record->result_bytes = 0;
    record->error = Error(Reason::storage, std::string("the result was lost: ") + error.what());
  }
  job->mesh_operator.reset();

  lock.lock();
  running -= job->state == JobState::running ? 1 : 0;
  job->state = record->state;
  job->final_record = record;
  ++ended;  // before the end event: who sees that finds the job counted
  job->cases.clear();
  kept.push_back({job->id, record->result_bytes + job->log->bytes()});
  const std::vector<std::string> forgotten = forget_oldest();
  lock.unlock();
  for (const std::string& id : forgotten) {
    try {
      store.erase_job(id);
    } catch (const Error&) {
      // A client has erased it in this moment.
    }
  }

  job->log->append(EndEvent{std::move(record)});
  lock.lock();
  ++announced;
  lock.unlock();
  changed.notify_all();
}

std::vector<std::string> JobEngine::State::forget_oldest() {
  std::vector<std::uint64_t> bytes;
  bytes.reserve(kept.size());
  for (const Kept& entry : kept) {
    bytes.push_back(entry.bytes);
  }
  std::vector<std::string> forgotten;
  for (std::size_t count = jobs_to_drop(bytes, static_cast<std::size_t>(options.max_kept_jobs),
                                        options.max_kept_bytes);
       count > 0; --count) {
    jobs.erase(kept.front().id);
    forgotten.push_back(std::move(kept.front().id));
    kept.pop_front();
  }
  return forgotten;
}

}  // namespace anticrack::jobs
