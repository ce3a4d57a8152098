// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/spreading.hpp"

#include <algorithm>
#include <utility>

#include "jobs/event_rows.hpp"
#include "jobs/intake.hpp"
#include "jobs/portion_codec.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using Lock = EngineCore::Lock;

constexpr std::chrono::milliseconds look_every{100};
/// How long a server helps with a sweep before it looks whose is next.
constexpr std::chrono::seconds help_for{10};
/// Portions that no thread here comes to for so long are given back.
constexpr std::chrono::seconds longest_wait{1};

std::size_t threads(const EngineCore& core) {
  return static_cast<std::size_t>(std::max(1, core.options.threads));
}

/// Whether each solver thread has a turn. With the lock held.
bool all_busy(const EngineCore& core) {
  std::size_t busy = 0;
  for (const auto& [id, mesh] : core.meshes) busy += static_cast<std::size_t>(mesh->threads);
  return busy >= threads(core);
}

/// Units that wait for a thread, of all jobs. With the lock held.
std::size_t waiting_here(const EngineCore& core) {
  std::size_t waiting = 0;
  for (const auto& [id, mesh] : core.meshes)
    for (const std::uint64_t units : mesh->waiting)
      waiting += mesh->mesh_operator ? static_cast<std::size_t>(units) : 0;
  return waiting;
}

std::uint64_t portions_of(const SweepPlan& plan) {
  return (plan.chunks() + plan.portion_chunks - 1) / plan.portion_chunks;
}

/// Whether the portion has the rows that it has by this server's own plan.
bool fits(const store::Portion& portion, const SweepPlan& plan) {
  const std::uint64_t rows = plan.chunk_rows * plan.portion_chunks;
  return portion.number < portions_of(plan) && portion.first == portion.number * rows &&
         portion.count == std::min(rows, plan.rows - portion.first);
}

/// Writes the portions that were solved here.
void write_solved(EngineCore& core, const JobPtr& job, SpreadSweep& spread) {
  Lock lock(core.mutex);
  const LiveSweep& sweep = *job->sweep;
  while (!spread.unwritten.empty()) {
    const std::uint64_t number = *spread.unwritten.begin();
    std::vector<std::pair<SweepChunk, records::SweepRecord>> chunks;
    const std::size_t first = number * sweep.plan.portion_chunks;
    const std::size_t end = std::min(first + sweep.plan.portion_chunks, sweep.plan.chunks());
    for (std::size_t i = first; i < end; ++i)
      chunks.emplace_back(sweep.chunks[i], spread.sums.at(i));
    lock.unlock();
    core.queue->solved(job->id(), {number, pack(chunks, *job->spool)});
    lock.lock();
    spread.unwritten.erase(number);
    spread.sums.erase(spread.sums.lower_bound(first), spread.sums.lower_bound(end));
  }
}

/// Takes over what other servers solved.
void fetch_solved(EngineCore& core, const JobPtr& job, SpreadSweep& spread) {
  for (;;) {
    Lock lock(core.mutex);
    const std::vector<std::int64_t> known(spread.known.begin(), spread.known.end());
    lock.unlock();
    const std::vector<store::SolvedPortion> portions =
        core.queue->solved_portions(job->id(), known);
    if (portions.empty()) return;
    for (const store::SolvedPortion& portion : portions) {
      for (EndedChunk& chunk : unpack(portion, job)) {
        lock.lock();
        ++job->active;
        lock.unlock();
        core.deliver(std::move(chunk));
      }
      lock.lock();
      spread.known.insert(portion.number);
      lock.unlock();
    }
    core.rows->publish({job});  // before so many rows push one another out of the log
  }
}

/// Takes portions for threads that will need them. Of a sweep that runs elsewhere it also finds out
/// whether that still wants them.
void take_more(EngineCore& core, const JobPtr& job, SpreadSweep& spread, bool look) {
  Lock lock(core.mutex);
  const SweepPlan& plan = job->sweep->plan;
  const auto now = EngineCore::Clock::now();
  const std::size_t most = threads(core);
  const std::size_t waiting = job->helps ? waiting_here(core) : job->units - job->next_unit;
  const bool served = job->active > 1;
  if (served || job->next_unit == job->units) spread.served = now;
  const bool may = !job->helps || ((served || !all_busy(core)) && now - spread.begun < help_for);
  const std::size_t wanted =
      may && waiting <= most ? (2 * most - waiting + plan.portion_chunks - 1) / plan.portion_chunks
                             : 0;
  if (wanted == 0 && !(job->helps && look)) return;
  lock.unlock();
  const std::vector<store::Portion> mine = core.queue->take_portions(job->id(), wanted);
  lock.lock();
  if (job->why != Stop::none) return;
  const bool fit = std::ranges::all_of(mine, [&](const auto& one) { return fits(one, plan); });
  std::size_t kept = 0, added = 0;
  for (const store::Portion& one : mine) kept += spread.open.count(one.number);
  const bool lost = kept < spread.open.size();
  for (const store::Portion& one : mine) {
    if (!fit || spread.open.contains(one.number) || spread.unwritten.contains(one.number) ||
        spread.known.contains(one.number))
      continue;
    const std::size_t chunks = (one.count + plan.chunk_rows - 1) / plan.chunk_rows;
    for (std::size_t i = 0; i < chunks; ++i)
      spread.units.push_back(one.number * plan.portion_chunks + i);
    spread.open[one.number] = chunks;
    added += chunks;
  }
  if (added > 0) {
    job->units += added;
    core.meshes.at(job->mesh)->waiting[index(job->lane)] += added;
    core.offer(job);
  }
  const bool done = spread.open.empty() && spread.unwritten.empty();
  const bool starved = job->next_unit < job->units && now - spread.served > longest_wait;
  lock.unlock();
  if (!fit)
    core.stop(job, Stop::failed,
              Error(errors::Reason::internal, "another server has other chunks of this sweep"));
  else if (job->helps && (lost || done || starved))
    core.stop(job, Stop::interrupted);
}

/// Ends what this server does for a sweep that has ended or was stopped.
void leave_sweep(EngineCore& core, const JobPtr& job) {
  Lock lock(core.mutex);
  const Stop why = job->why;
  const auto found = core.jobs.find(job->id());
  const bool anew = found != core.jobs.end() && found->second != job;  // it has the portions
  lock.unlock();
  try {
    if (!anew && why != Stop::none) {
      if (job->helps || why == Stop::interrupted)
        core.queue->give_back_portions(job->id());
      else
        core.queue->withdraw_portions(job->id(), job->created.attempt);
    }
  } catch (const Error&) {
    // They go with the job, or with the lease of this server.
  }
  lock.lock();
  job->sweep->spread.reset();
  --job->active;
  core.settle(job);
}

void attend(EngineCore& core, const JobPtr& job) {
  Lock lock(core.mutex);
  const bool runs_here = core.jobs.contains(job->id());
  const bool alone = job->helps && job->sweep && !job->sweep->spread;  // by its own limits
  if (job->why == Stop::none && job->helps && (core.draining || runs_here || alone)) {
    lock.unlock();
    core.stop(job, alone ? Stop::failed : Stop::interrupted);
    lock.lock();
  }
  if (!job->sweep || !job->sweep->spread) return;
  SpreadSweep& spread = *job->sweep->spread;
  if (job->why != Stop::none) {
    lock.unlock();
    return leave_sweep(core, job);
  }
  if (!spread.ready) return;
  const auto now = EngineCore::Clock::now();
  const bool look = now - spread.looked >= look_every;
  if (look) spread.looked = now;
  lock.unlock();
  const SweepPlan& plan = job->sweep->plan;
  try {
    if (!job->helps && !spread.offered)
      core.queue->spread(job->id(), job->created.attempt, plan.rows,
                         plan.chunk_rows * plan.portion_chunks);
    spread.offered = true;
    take_more(core, job, spread, look);
    write_solved(core, job, spread);
    if (!job->helps && look) fetch_solved(core, job, spread);
  } catch (const store::JobTaken&) {
    core.stop(job, Stop::interrupted);
  } catch (const Error& error) {
    const bool out_of_reach = error.retry_delay().count() > 0;
    if (!out_of_reach) core.stop(job, Stop::failed, error);
  }
  lock.lock();
  const bool all = !job->helps && spread.known.size() == portions_of(plan);
  lock.unlock();
  if (all) leave_sweep(core, job);
}

}  // namespace

void solve_together(EngineCore& core) {
  Lock lock(core.mutex);
  while (!core.quitting) {
    std::vector<JobPtr> sweeps;
    for (const auto& [number, job] : core.numbers)
      if (job->helps || (job->sweep && job->sweep->spread)) sweeps.push_back(job);
    lock.unlock();
    for (const JobPtr& job : sweeps) attend(core, job);
    sweeps.clear();
    lock.lock();
    core.spreading.wait_for(
        lock, look_every, [&] { return core.quitting || std::exchange(core.chunks_ended, false); });
  }
}

void help(EngineCore& core, const std::vector<std::string>& meshes_held) {
  Lock lock(core.mutex);
  const bool helps =
      std::ranges::any_of(core.numbers, [](const auto& entry) { return entry.second->helps; });
  if (core.draining || core.memory->exceeded() || helps || waiting_here(core) > 0 || all_busy(core))
    return;
  const std::vector<std::string> except(core.not_helped.begin(), core.not_helped.end());
  lock.unlock();
  if (std::optional<records::JobRecord> record = core.queue->to_help(meshes_held, except))
    take_up(core, std::move(*record), "", true);
}

void note_solved(EngineCore& core, const EndedChunk& chunk) {
  const LiveJob& job = *chunk.task.job;
  SpreadSweep* const spread = job.sweep->spread.get();
  if (spread == nullptr) return;
  core.chunks_ended = true;
  core.spreading.notify_one();
  if (!chunk.columns) return;
  spread->sums[chunk.task.index] = chunk.record;
  const std::uint64_t number = chunk.task.index / job.sweep->plan.portion_chunks;
  if (--spread->open.at(number) > 0) return;
  spread->open.erase(number);
  spread->unwritten.insert(number);
  if (!job.helps) spread->known.insert(number);
}

}  // namespace anticrack::jobs
