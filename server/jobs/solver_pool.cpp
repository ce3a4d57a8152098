// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/solver_pool.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <limits>
#include <system_error>
#include <utility>

#include "base/at_once.hpp"
#include "jobs/block_run.hpp"
#include "jobs/condensing.hpp"
#include "jobs/exact_run.hpp"
#include "jobs/growth_final.hpp"
#include "jobs/job_start.hpp"
#include "jobs/stage_end.hpp"
#include "stop/stop.hpp"

namespace anticrack::jobs {

namespace {

using Clock = EngineCore::Clock;

/// Threads beyond EngineOptions::threads.
constexpr std::size_t most_spare_threads = 8;
constexpr int most_stage_ends = 4;  // at once

contact::Mass mass_of(Lane lane) {
  return lane == Lane::consistent ? contact::Mass::consistent : contact::Mass::lumped;
}

}  // namespace

SolverPool::SolverPool(EngineCore& core) : _core(core) {
  for (std::size_t i = 0; i < threads(); ++i) {
    std::jthread thread = core.start([this] { work(); });
    const std::lock_guard lock(core.mutex);
    _threads.push_back(std::move(thread));
  }
}

std::size_t SolverPool::threads() const noexcept {
  return static_cast<std::size_t>(std::max(1, _core.options.threads));
}

std::size_t SolverPool::idle() const noexcept {
  return threads() - std::min(threads(), _working.size());
}

std::optional<Turn> SolverPool::next_turn() {
  const auto now = Clock::now();
  if (_working.size() < threads()) return _core.schedule.next_turn(now);
  const bool all_long = std::all_of(_working.begin(), _working.end(), [&](const Working& other) {
    return now - other.step >= _core.options.long_step;
  });
  if (!all_long) return std::nullopt;
  return _core.schedule.next_turn(now, [&](const std::string& mesh, const std::string& owner) {
    return std::any_of(_working.begin(), _working.end(), [&](const Working& other) {
      return owner.empty() ? other.mesh == mesh : other.owner == owner;
    });
  });
}

void SolverPool::keep_a_spare() {
  if (_resting > 0) {
    _core.solvers.notify_one();
    return;
  }
  if (_threads.size() >= threads() + most_spare_threads) return;
  try {
    _threads.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    // Without a spare thread long steps hold up other work, as too many of them do anyway.
  }
}

void SolverPool::rest(Lock& lock) {
  constexpr std::chrono::milliseconds least(5);
  ++_resting;
  if (!_watched && _working.size() >= threads() && _core.schedule.any()) {
    _watched = true;
    _core.solvers.wait_for(lock, std::max(least, _core.options.long_step / 2));
    _watched = false;
  } else {
    _core.solvers.wait(lock);
  }
  --_resting;
}

void SolverPool::work() {
  Lock lock(_core.mutex);
  while (!_core.quitting) {
    if (!_core.to_refine.empty() && _at_stage_ends < most_stage_ends) {
      ++_at_stage_ends;
      keep_a_spare();
      const JobPtr job = _core.to_refine.pop();
      lock.unlock();
      end_stage(_core, job);
      lock.lock();
      --_at_stage_ends;
      continue;
    }
    const std::optional<Turn> turn = next_turn();
    if (!turn) {
      rest(lock);
      continue;
    }
    const Mesh mesh = _core.meshes.at(turn->mesh);
    _core.end_wait(*mesh);
    const auto now = Clock::now();
    const auto working =
        _working.insert(_working.end(), Working{turn->mesh, turn->owner, now, now});
    keep_a_spare();
    ++mesh->threads;
    lock.unlock();
    if (turn->lane == Lane::active_set)
      solve_exactly(mesh, *working);
    else if (turn->lane == Lane::sweep)
      sweep(mesh, *working);
    else
      iterate(mesh, turn->lane, *working);
    lock.lock();
    --mesh->threads;
    _working.erase(working);
    _core.schedule.served(mesh->id, Clock::now());
    _core.release(mesh);
  }
}

bool SolverPool::turn_is_over(const MeshWork& mesh, Lane lane, const Working& working) const {
  return Clock::now() - working.begin >= _core.options.turn &&
         (_working.size() > threads() || _core.schedule.others(mesh.id, lane));
}

bool SolverPool::overtaken(const MeshWork& mesh, Lane lane, const BlockRun& block) const {
  const auto waiting = _core.schedule.most_urgent(mesh.id, lane);
  return waiting && block.free() == 0 && *waiting < block.priority();
}

void SolverPool::iterate(const Mesh& mesh, Lane lane, Working& working) {
  std::shared_ptr<BlockRun> block;
  auto& parked = mesh->parked[index(lane)];
  Lock lock(_core.mutex);
  const bool all_overtaken = std::all_of(
      parked.begin(), parked.end(),
      [&](const std::shared_ptr<BlockRun>& other) { return overtaken(*mesh, lane, *other); });
  if (!parked.empty() && !all_overtaken) {
    block = std::move(parked.front());
    parked.pop_front();
    _core.schedule.unpark(mesh->id, lane, block->parked_as);
  }
  for (;;) {
    working.step = Clock::now();
    lock.unlock();
    admit(mesh, lane, block);
    lock.lock();
    if (!block || block->columns() == 0) break;
    working.step = Clock::now();
    lock.unlock();
    _core.deliver(step(*block));
    lock.lock();
    const bool leave =
        turn_is_over(*mesh, lane, working) ||
        (Clock::now() - working.begin >= _core.options.turn && overtaken(*mesh, lane, *block));
    if (leave) {
      block->parked_as = block->priority();
      _core.schedule.park(mesh->id, lane, block->parked_as);
      parked.push_back(std::move(block));
      _core.solvers.notify_one();
      return;
    }
  }
  std::erase(mesh->blocks, block);
}

void SolverPool::admit(const Mesh& mesh, Lane lane, std::shared_ptr<BlockRun>& block) {
  Lock lock(_core.mutex);
  const bool under_way = block && block->columns() > 0;
  if (under_way && idle() > 0) {
    if (mesh->waiting[index(lane)] > 0)
      _core.solvers.notify_one();  // another thread may have nothing else to do
    return;
  }
  const int room = block ? block->free() : std::max(1, _core.options.columns);
  lock.unlock();
  // A start waits for the disk, so while columns wait there is only one start at a time.
  const int max_starts = under_way ? 1 : std::numeric_limits<int>::max();
  const std::vector<Task> tasks = take(mesh, lane, room, max_starts);
  if (tasks.empty()) return;
  Condensed condensed;
  try {
    if (!block) {
      const stop::Scope scope([&tasks](const stop::Look&) {  // theta* may take long
        return std::ranges::all_of(
            tasks, [](const Task& task) { return task.job->stop.stop_requested(); });
      });
      block =
          std::make_shared<BlockRun>(mesh->mesh_operator, mass_of(lane), room, _core.iterations);
    }
    condensed = condense(*mesh->mesh_operator, tasks, _core.store);
  } catch (...) {  // no block can be made on this mesh, so all its cases fail
    for (const Task& task : tasks)
      condensed.ended.push_back({task, failed_case(task, std::current_exception())});
  }
  lock.lock();
  _core.columns -= static_cast<int>(tasks.size());
  if (!condensed.prepared.empty()) {
    if (std::find(mesh->blocks.begin(), mesh->blocks.end(), block) == mesh->blocks.end())
      mesh->blocks.push_back(block);
    block->iterating = true;
    lock.unlock();
    for (PreparedCase& prepared : condensed.prepared) {
      try {
        block->add(prepared.task, std::move(prepared.load));
      } catch (...) {
        condensed.ended.push_back(
            {prepared.task, failed_case(prepared.task, std::current_exception())});
      }
    }
    lock.lock();
    block->iterating = false;
  }
  lock.unlock();
  _core.deliver(std::move(condensed.ended));
}

std::vector<EndedCase> SolverPool::step(BlockRun& block) {
  std::vector<EndedCase> ended;
  Lock lock(_core.mutex);
  for (const Task& task : block.abandon_stopped()) ended.push_back({task, cancelled_case(task)});
  const int columns = block.columns();
  block.iterating = true;
  _core.columns += columns;
  lock.unlock();
  for (EndedCase& ended_case : block.step()) ended.push_back(std::move(ended_case));
  lock.lock();
  _core.columns -= columns;
  block.iterating = false;
  return ended;
}

void SolverPool::solve_exactly(const Mesh& mesh, Working& working) {
  Lock lock(_core.mutex);
  do {
    working.step = Clock::now();
    std::vector<EndedCase> ended;
    if (mesh->prepared.empty()) {
      lock.unlock();
      const std::vector<Task> tasks =
          take(mesh, Lane::active_set, std::max(1, _core.options.columns),
               std::numeric_limits<int>::max());
      if (tasks.empty()) return;
      lock.lock();
      // Threads that are idle take what waits, if anything does.
      const bool waiting = mesh->waiting[index(Lane::active_set)] > 0;
      const base::Threads helped(waiting ? 1 : 1 + static_cast<int>(idle()));
      lock.unlock();
      Condensed condensed = condense(*mesh->mesh_operator, tasks, _core.store);
      ended = std::move(condensed.ended);
      lock.lock();
      _core.columns -= static_cast<int>(tasks.size());
      for (PreparedCase& prepared : condensed.prepared) {
        if (prepared.task.job->why == Stop::none) {
          _core.schedule.park(mesh->id, Lane::active_set, prepared.task.job->spec->priority);
          mesh->prepared.push_back(std::move(prepared));
        } else {
          ended.push_back({prepared.task, cancelled_case(prepared.task)});
        }
      }
      _core.solvers.notify_all();
    }
    // With the lock held since they were prepared: a thread that took over a lone case would count
    // this one as at work, and solve it without its help.
    if (!mesh->prepared.empty()) {
      working.step = Clock::now();
      const base::Threads helped(1 + static_cast<int>(idle()));
      const std::vector<PreparedCase> cases =
          take_together(mesh->prepared, static_cast<int>(idle()) + 1);
      for (const PreparedCase& prepared : cases)
        _core.schedule.unpark(mesh->id, Lane::active_set, prepared.task.job->spec->priority);
      _core.columns += static_cast<int>(cases.size());
      lock.unlock();
      std::ranges::move(jobs::solve_exactly(cases, _core), std::back_inserter(ended));
      lock.lock();
      _core.columns -= static_cast<int>(cases.size());
    }
    lock.unlock();
    _core.deliver(std::move(ended));
    lock.lock();
  } while (!turn_is_over(*mesh, Lane::active_set, working));
}

void SolverPool::sweep(const Mesh& mesh, Working& working) {
  Lock lock(_core.mutex);
  do {
    working.step = Clock::now();
    lock.unlock();
    const std::vector<Task> tasks = take(mesh, Lane::sweep, 1, std::numeric_limits<int>::max());
    if (tasks.empty()) return;
    EndedChunk chunk = tasks.front().job->sweep ? solve_chunk(tasks.front(), _core.iterations)
                                                : solve_position(tasks.front(), _core.catalogue);
    lock.lock();
    --_core.columns;
    lock.unlock();
    _core.deliver(std::move(chunk));
    lock.lock();
  } while (!turn_is_over(*mesh, Lane::sweep, working));
}

std::vector<Task> SolverPool::take(const Mesh& mesh, Lane lane, int room, int max_starts) {
  std::vector<Task> tasks;
  std::vector<EndedCase> refused;
  Lock lock(_core.mutex);
  const std::uint64_t waiting = mesh->waiting[index(lane)];
  const std::uint64_t shares = static_cast<std::uint64_t>(idle()) + 1;
  const std::uint64_t wanted =
      std::min(static_cast<std::uint64_t>(std::max(0, room)), (waiting + shares - 1) / shares);
  while (tasks.size() < wanted) {
    const auto next = _core.schedule.next_job(mesh->id, lane, Clock::now());
    if (!next) break;
    const JobPtr job = _core.numbers.at(*next);
    if (!job->mesh_operator) {
      if (max_starts-- == 0) break;
      if (!may_start(_core, job)) continue;
      lock.unlock();
      start_job(_core, mesh->mesh_operator, job);
      lock.lock();
      continue;
    }
    Task task = take_unit(job);
    _core.schedule.taken(job->number, Clock::now());
    --mesh->waiting[index(lane)];
    if (job->next_unit == job->units) _core.schedule.remove(job->number);
    if (job->result_bytes > _core.options.max_result_bytes)
      refused.push_back({task, refused_case(task, _core.options.max_result_bytes)});
    else
      tasks.push_back(std::move(task));
  }
  _core.columns += static_cast<int>(tasks.size());
  lock.unlock();
  _core.deliver(std::move(refused));
  return tasks;
}

}  // namespace anticrack::jobs
