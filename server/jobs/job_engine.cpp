// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/job_engine.hpp"

#include <algorithm>
#include <cstdio>
#include <random>
#include <utility>

#include "errors/errors.hpp"
#include "jobs/check.hpp"
#include "jobs/engine_state.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using store::JobRecord;
using JobPtr = std::shared_ptr<LiveJob>;

constexpr std::chrono::milliseconds retry_delay{1000};

/// Unique across restarts as well, so it cannot be a counter.
std::string new_id() {
  std::random_device random;
  std::string id;
  for (int i = 0; i < 2; ++i) {
    char digits[9];
    std::snprintf(digits, sizeof digits, "%08x", random());
    id += digits;
  }
  return id;
}

Error unknown(const std::string& id) {
  return {Reason::not_found, "there is no jobs/" + id};
}

Error queue_full(int limit) {
  return Error(Reason::busy,
               "the queue is full (" + std::to_string(limit) + " jobs): try again in a while")
      .retry_after(retry_delay);
}

}  // namespace

JobEngine::JobEngine(EngineOptions options, store::Store& store, meshes::MeshCatalogue& catalogue)
    : _state(std::make_unique<State>(options, store, catalogue)) {}

JobEngine::~JobEngine() {
  stop(std::chrono::milliseconds(0));
}

JobRecord JobEngine::submit(const store::JobSpec& spec, const std::string& request_id) {
  State& state = *_state;
  check(spec, state.options);
  try {
    state.catalogue.get(spec.mesh);
  } catch (Error& error) {
    error.at("mesh");
    throw;
  }
  require_arrays(spec.loads, state.store);
  JobRecord record;
  record.id = new_id();
  record.spec = spec;
  record.created = store::Clock::now();
  record.cases.resize(spec.loads.size());
  const std::string print = fingerprint(spec);

  State::Lock lock(state.mutex);
  const std::string id = state.store.create(record, request_id, print).id;
  if (id != record.id) {
    lock.unlock();
    return get(id);
  }
  // Only now is it known to be new: the same request again is answered when full as well.
  const bool full = state.queue.size() >= static_cast<std::size_t>(state.options.max_queued_jobs);
  if (state.draining || full) {
    state.store.erase_job(id);
    throw state.draining ? Error(Reason::draining, "the server is stopping: submit to another one")
                         : queue_full(state.options.max_queued_jobs);
  }
  auto job = std::make_shared<LiveJob>(++state.created, record, state.options.event_log_bytes);
  state.jobs.emplace(id, job);
  state.queue.add(std::move(job));
  state.changed.notify_all();
  return record;
}

JobRecord JobEngine::get(const std::string& id) const {
  std::optional<JobSnapshot> snapshot;
  {
    const std::lock_guard lock(_state->mutex);
    if (const auto found = _state->jobs.find(id); found != _state->jobs.end()) {
      snapshot.emplace(*found->second);
    }
  }
  if (snapshot) {
    return snapshot->record();
  }
  std::optional<JobRecord> record = _state->store.job(id);
  if (!record) {
    throw unknown(id);
  }
  return std::move(*record);
}

std::vector<JobRecord> JobEngine::list(const std::string& after, std::size_t count) const {
  std::vector<JobRecord> records = _state->store.jobs(after, count);
  for (JobRecord& record : records) {
    std::optional<JobSnapshot> snapshot;
    {
      const std::lock_guard lock(_state->mutex);
      const auto found = _state->jobs.find(record.id);
      if (found != _state->jobs.end() && !found->second->final_record) {
        snapshot.emplace(*found->second);
      }
    }
    if (snapshot) {
      record = snapshot->record();
    }
  }
  return records;
}

JobRecord JobEngine::cancel(const std::string& id) {
  JobPtr job;
  {
    const std::lock_guard lock(_state->mutex);
    if (const auto found = _state->jobs.find(id);
        found != _state->jobs.end() && !found->second->final_record) {
      job = found->second;
    }
  }
  if (job) {
    _state->cancel(job);
  }
  return get(id);
}

void JobEngine::erase(const std::string& id) {
  {
    const std::lock_guard lock(_state->mutex);
    const auto found = _state->jobs.find(id);
    if (found != _state->jobs.end()) {
      if (!found->second->final_record) {
        throw Error(Reason::in_use, "jobs/" + id + " has not ended: cancel it first");
      }
      _state->jobs.erase(found);
      std::erase_if(_state->kept, [&](const auto& kept) { return kept.id == id; });
    }
  }
  _state->store.erase_job(id);
}

std::shared_ptr<EventLog> JobEngine::events(const std::string& id) const {
  const std::lock_guard lock(_state->mutex);
  const auto found = _state->jobs.find(id);
  if (found == _state->jobs.end()) {
    throw unknown(id);
  }
  return found->second->log;
}

std::shared_ptr<const store::Block> JobEngine::result(const std::string& id) const {
  {
    const std::lock_guard lock(_state->mutex);
    const auto found = _state->jobs.find(id);
    if (found != _state->jobs.end() && !found->second->final_record) {
      throw Error(Reason::not_ready, "jobs/" + id + " has not ended: wait for it");
    }
  }
  std::shared_ptr<const store::Block> block = _state->store.result(id);
  if (!block) {
    if (!_state->store.job(id)) {
      throw unknown(id);
    }
    throw Error(Reason::not_ready, "jobs/" + id + " ended and no load case has an answer");
  }
  return block;
}

void JobEngine::stop(std::chrono::milliseconds grace) {
  State& state = *_state;
  const auto unended = [&](bool with_running) {
    std::vector<JobPtr> jobs;
    for (const auto& [id, job] : state.jobs) {
      if (!job->final_record && (with_running || job->state != store::JobState::running)) {
        jobs.push_back(job);
      }
    }
    return jobs;
  };
  const auto cancel_all = [&](State::Lock& lock, const std::vector<JobPtr>& jobs) {
    lock.unlock();
    for (const JobPtr& job : jobs) {
      state.cancel(job);
    }
    lock.lock();
  };
  const auto idle = [&] { return state.announced == state.created; };

  State::Lock lock(state.mutex);
  state.draining = true;
  cancel_all(lock, unended(false));
  state.changed.wait_for(lock, grace, idle);
  cancel_all(lock, unended(true));
  state.changed.wait(lock, idle);
}

bool JobEngine::idle() const {
  const std::lock_guard lock(_state->mutex);
  return _state->announced == _state->created;
}

EngineMetrics JobEngine::metrics() const {
  const std::lock_guard lock(_state->mutex);
  EngineMetrics metrics;
  metrics.jobs_created = _state->created;
  metrics.jobs_ended = _state->ended;
  metrics.load_cases_ended = _state->cases_ended;
  metrics.iterations = _state->iterations;
  metrics.jobs_queued = static_cast<int>(_state->queue.size());
  metrics.jobs_running = _state->running;
  return metrics;
}

const EngineOptions& JobEngine::options() const noexcept {
  return _state->options;
}

}  // namespace anticrack::jobs
