// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/claims.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "jobs/event_rows.hpp"
#include "jobs/intake.hpp"
#include "jobs/spreading.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using Lock = EngineCore::Lock;

/// A job that was just queued may be for another server during this time (store/queue.hpp).
constexpr std::chrono::milliseconds look_again{250};
constexpr std::chrono::seconds beat_every{1}, list_held_every{1};
/// Meshes on their way beside those that are solved on: as many as meshes/queue.hpp makes ahead.
constexpr std::size_t meshes_ahead = 5;

/// How many jobs more this server takes: some for each thread, so that none is idle while a claim
/// is made, and some that wait for their meshes. With the lock held.
std::size_t room(const EngineCore& core) {
  if (core.draining || core.memory->exceeded()) return 0;
  const auto ahead = std::ranges::count_if(
      core.meshes, [](const auto& mesh) { return mesh.second->mesh_operator == nullptr; });
  const std::size_t most = 2 * static_cast<std::size_t>(std::max(1, core.options.threads)) +
                           std::min(meshes_ahead, static_cast<std::size_t>(ahead));
  const auto taken = static_cast<std::size_t>(core.live + core.not_announced);
  return most - std::min(most, taken);
}

/// The ids of all jobs that are live or ending here.
std::vector<std::string> known(EngineCore& core) {
  std::vector<std::string> ids;
  const std::lock_guard lock(core.mutex);
  for (const auto& [id, job] : core.jobs) ids.push_back(id);
  return ids;
}

void take(EngineCore& core, store::Queue::Claim claim) {
  const bool again = claim.record.attempt > 1;
  const JobPtr job =
      take_up(core, std::move(claim.record), again ? "another server had it before" : "");
  if (claim.cancelled) core.stop(job, Stop::cancelled);
}

}  // namespace

Claims::Claims(EngineCore& core)
    : _core(core),
      _claiming(core.start([this] { claim(); })),
      _beating(core.start([this] { beat(); })),
      _telling(core.start([&core] { core.rows->work(); })),
      _spreading(core.start([&core] { solve_together(core); })) {
  core.queue->listen([&core](bool cancelled) {
    const std::lock_guard lock(core.mutex);
    (cancelled ? core.flags_changed : core.queue_changed) = true;
    core.claiming.notify_all();
  });
}

Claims::~Claims() { _core.queue->listen({}); }

void Claims::claim() {
  std::vector<std::string> held;
  EngineCore::Clock::time_point listed{};
  Lock lock(_core.mutex);
  while (!_core.quitting) {
    _core.queue_changed = false;
    std::size_t claimed = 0;
    if (const std::size_t free = room(_core); free > 0) {
      ++_core.claims_under_way;
      std::vector<std::string> meshes;
      for (const auto& [id, mesh] : _core.meshes) meshes.push_back(id);
      lock.unlock();
      try {
        if (const auto now = EngineCore::Clock::now(); now - listed >= list_held_every) {
          held = _core.catalogue.in_memory();
          listed = now;
        }
        meshes.insert(meshes.end(), held.begin(), held.end());
        for (store::Queue::Claim& one : _core.queue->claim(free, meshes, known(_core))) {
          ++claimed;
          take(_core, std::move(one));
        }
        if (claimed == 0) help(_core, meshes);
      } catch (const Error&) {
        // The database cannot be reached; beats give back what was claimed and is not here.
      }
      lock.lock();
      --_core.claims_under_way;
      _core.settled.notify_all();
    }
    if (claimed == 0)
      _core.claiming.wait_for(lock, look_again,
                              [&] { return _core.quitting || _core.queue_changed; });
  }
}

void Claims::beat() {
  Lock lock(_core.mutex);
  while (!_core.quitting) {
    _core.flags_changed = false;
    std::vector<JobPtr> live;
    std::vector<std::string> ids;
    for (const auto& [id, job] : _core.jobs) {
      live.push_back(job);
      ids.push_back(id);
    }
    lock.unlock();
    try {
      const store::Queue::News news = _core.queue->beat(ids);
      _core.leases_lost += news.lost ? 1 : 0;
      for (const JobPtr& job : live) {
        if (news.lost)
          _core.stop(job, Stop::interrupted);
        else if (std::ranges::count(news.cancelled, job->id()) > 0)
          _core.stop(job, Stop::cancelled);
      }
    } catch (const Error&) {
      // Others judge this server by its beats; what it loses it hears with the next one.
    }
    live.clear();
    lock.lock();
    _core.claiming.wait_for(lock, beat_every,
                            [&] { return _core.quitting || _core.flags_changed; });
  }
}

void Claims::give_back() {
  {
    Lock lock(_core.mutex);
    _core.settled.wait(lock, [&] { return _core.claims_under_way == 0; });
  }
  try {
    _core.queue->give_back(known(_core));
  } catch (const Error&) {
    // Then others take the jobs when the beats of this server have stopped.
  }
}

void Claims::leave() {
  give_back();
  try {
    _core.queue->leave();
  } catch (const Error&) {
    // As above.
  }
}

void cancel_in_group(EngineCore& core, const std::string& id) {
  Lock lock(core.mutex);
  if (core.draining)
    throw Error(errors::Reason::draining, "the server is stopping: ask another one");
  ++core.claims_under_way;
  lock.unlock();
  std::optional<Error> failure;
  try {
    if (auto claim = core.queue->claim_to_cancel(id)) take(core, std::move(*claim));
  } catch (const Error& error) {
    failure = error;
  }
  lock.lock();
  --core.claims_under_way;
  core.settled.notify_all();
  if (failure) throw Error(*failure);
}

}  // namespace anticrack::jobs
