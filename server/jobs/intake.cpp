// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/intake.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <random>
#include <utility>

#include "errors/placed.hpp"
#include "fields/walk.hpp"
#include "jobs/check.hpp"
#include "jobs/job_start.hpp"
#include "jobs/result_block.hpp"
#include "jobs/sweep_check.hpp"
#include "records/case_record.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;
using records::JobRecord;
using records::JobState;

/// An id that is unique across restarts as well, so it cannot be a counter.
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

JobRecord new_record(const Submission& submission) {
  JobRecord record;
  record.id = new_id();
  record.owner = submission.owner;
  record.request_id = submission.request_id;
  record.spec = submission.spec;
  record.created = records::Clock::now();
  record.cases.resize(case_count(submission.spec));
  record.timeline.push_back({record.created, JobState::queued, {}});
  return record;
}

std::shared_ptr<void> use(EngineCore& core, const std::string& mesh) {
  return errors::at("mesh", [&] { return core.catalogue.use(mesh); });
}

/// A place in the queue; the destructor gives it back unless the job has taken it.
class Place {
 public:
  /// Reserves the place. Throws errors::Error (draining, limit_exceeded, busy).
  Place(EngineCore& core, const JobRecord& record, std::uint64_t cases)
      : _core(core),
        _owner(record.owner),
        _mesh(record.spec.mesh),
        _cases(cases),
        _bytes(fields::bytes_of(record.spec)) {
    const std::lock_guard lock(core.mutex);
    if (core.draining)
      throw Error(Reason::draining, "the server is stopping: submit to another one");
    core.logs.make_room(_bytes);
    core.admission.check(_owner, _mesh, _cases, _bytes, core.memory->used());
    core.admission.add(_owner, _mesh, _cases, _bytes);
    _memory.emplace(core.memory, _bytes);
  }
  ~Place() {
    if (!_taken) {
      const std::lock_guard lock(_core.mutex);
      _core.admission.started();
      _core.admission.cases_ended(_mesh, _cases);
      _core.admission.ended(_owner, _bytes);
    }
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  void take() noexcept { _taken = true; }

 private:
  EngineCore& _core;
  const std::string _owner;
  const std::string _mesh;
  const std::uint64_t _cases;
  const std::uint64_t _bytes;
  std::optional<MemoryShare> _memory;
  bool _taken = false;
};

/// Sets the number of rows. For nodal forces it needs the mesh and is set when the job starts.
void measure(records::SweepSpec& sweep, const JobRecord& record, const EngineCore& core) {
  const std::uint64_t values = find_matrix(sweep, core.store, record.owner).values;
  sweep.rows = sweep.cases == records::SweepSpec::Cases::combinations
                   ? rows_of(sweep, values, record.spec.loads.size(), core.options.max_sweep_rows)
                   : 0;
}

/// Queues a job. With the lock held.
void queue(EngineCore& core, const JobPtr& job, EngineCore::Clock::time_point deadline) {
  if (!job->helps) core.deadlines.set(job->number, Due::queue_time, deadline);
  core.limits.notify_one();
  core.add(job);
}

/// Whether the last run of the server crashed. If the disk refuses the note, jobs count no crash.
bool crashed(EngineCore& core) {
  try {
    return core.store.set_running(true);
  } catch (const Error&) {
    return false;
  }
}

/// Puts a job into the queue of all servers, within the limits over all of them.
TakenIn queue_for_all(EngineCore& core, const Submission& submission, const JobRecord& record,
                      std::uint64_t cases) {
  const std::uint64_t bytes = fields::bytes_of(record.spec);
  EngineCore::Lock lock(core.mutex);
  if (core.draining) throw Error(Reason::draining, "the server is stopping: submit to another one");
  const Admission& admission = core.admission;
  lock.unlock();
  JobRecord stored = core.queue->create(
      record, submission.fingerprint, {cases, bytes}, [&](const store::QueueTotals& held) {
        admission.check(record.owner, record.spec.mesh, cases, bytes, held);
      });
  const bool is_new = stored.id == record.id;
  lock.lock();
  core.created += is_new ? 1 : 0;
  core.queue_changed = true;
  core.claiming.notify_all();
  return {std::move(stored), is_new};
}

std::optional<Error> too_many_crashes(const JobRecord& record, const EngineOptions& options) {
  if (options.max_crashes == 0 || record.crashes < options.max_crashes) return std::nullopt;
  return Error(Reason::internal,
               "the server crashed {} times while this job ran, so it is not run again: it may "
               "need more memory than the machine has; split it, use a larger mesh.size or "
               "tip_size, or ask the administrator for the server's log",
               record.crashes);
}

}  // namespace

TakenIn take_in(EngineCore& core, const Submission& submission) {
  check(submission.spec, core.options);
  JobRecord record = new_record(submission);
  std::shared_ptr<void> mesh_use = use(core, record.spec.mesh);
  const records::MeshRecord mesh = core.catalogue.get(record.spec.mesh);
  check_on_mesh(record.spec, mesh.definition);
  require_result_arrays(record.spec, mesh.interfaces.size(), mesh.subdomains.size(),
                        core.options.max_result_arrays);
  require_answers(record.spec, mesh.inclusions);
  require_arrays(record.spec.loads, core.store, record.owner);
  if (record.spec.sweep) measure(*record.spec.sweep, record, core);
  const std::uint64_t cases = queued_cases(record.spec, core.store, record.owner);
  if (core.queue != nullptr) return queue_for_all(core, submission, record, cases);
  Place place(core, record, cases);
  JobRecord stored = core.store.create(record, submission.fingerprint);
  if (stored.id != record.id)
    return {std::move(stored), false};  // the same request has just made it
  const EngineCore::Lock lock(core.mutex);
  ++core.created;
  if (!core.draining) {  // otherwise the job stays for the next start
    const auto job =
        std::make_shared<LiveJob>(++core.last_number, record, cases, core.options.event_log_bytes,
                                  std::move(mesh_use), core.memory);
    queue(core, job, job->since + queue_limit(*job, core.options));
    place.take();
  }
  return {std::move(stored), true};
}

JobPtr take_up(EngineCore& core, JobRecord record, const std::string& why, bool helps) {
  const bool waits_since_it_was_made = !record.started;
  record.state = JobState::queued;
  record.started.reset();
  if (record.stages.size() < 2) record.cases.assign(case_count(record.spec), {});
  record.sweep = {};
  if (!why.empty()) add_step(record.timeline, JobState::queued, why);
  std::shared_ptr<void> mesh_use, stage_use;
  if (!record.stages.empty()) {
    try {
      stage_use = core.catalogue.use(record.stages.back().mesh);
    } catch (const Error& error) {
      if (error.reason() != Reason::not_found) throw;
      record.stages.clear();  // the mesh of its stage is gone, so it begins anew
    }
  }
  std::optional<Error> gone = too_many_crashes(record, core.options);
  try {
    mesh_use = use(core, record.spec.mesh);
  } catch (const Error& error) {
    if (error.reason() != Reason::not_found) throw;  // the store cannot be reached
    gone = mesh_failed(record.spec.mesh, error);
  }
  const auto waited = waits_since_it_was_made ? records::Clock::now() - record.created
                                              : records::Clock::duration::zero();
  const std::uint64_t cases = queued_cases(record.spec, core.store, record.owner);
  EngineCore::Lock lock(core.mutex);
  const std::uint64_t number = ++core.last_number;
  lock.unlock();
  auto job =
      std::make_shared<LiveJob>(number, std::move(record), cases, core.options.event_log_bytes,
                                std::move(mesh_use), core.memory, core.queue != nullptr);
  if (job->stages) job->stages->mesh_use = std::move(stage_use);
  if (helps) {
    job->helps = true;
    job->lane = Lane::sweep;
    job->units = 1;  // until it starts
    job->cases.clear();
  }
  lock.lock();
  core.admission.add(job->created.owner, job->spec->mesh, cases, job->spec_bytes);
  queue(core, job,
        job->since + queue_limit(*job, core.options) -
            std::chrono::duration_cast<EngineCore::Clock::duration>(waited));
  lock.unlock();
  if (gone) core.stop(job, Stop::failed, gone);
  return job;
}

void recover(EngineCore& core) {
  for (store::EndedJob& job : core.store.ended()) core.retention.add(std::move(job));
  if (core.queue != nullptr) return;
  const bool after_crash = crashed(core);
  for (JobRecord& record : core.store.unfinished()) {
    if (record.state == JobState::running) {
      ++record.attempt;
      record.crashes += after_crash ? 1 : 0;
    }
    take_up(core, std::move(record), "the server was started");
  }
}

}  // namespace anticrack::jobs
