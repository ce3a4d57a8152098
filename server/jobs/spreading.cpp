// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/spreading.hpp"

#include <algorithm>
#include <utility>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "jobs/event_rows.hpp"
#include "jobs/growth_final.hpp"
#include "jobs/intake.hpp"
#include "jobs/portion_codec.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using Lock = EngineCore::Lock;

constexpr std::chrono::milliseconds look_every{100};
/// How long a server helps with a job before it looks whose is next.
constexpr std::chrono::seconds help_for{10};
/// What the server that runs a job solves faster than this stays there: to write it would take as
/// long, and to solve it again, should the server die, not much longer.
constexpr std::chrono::milliseconds worth_writing{50};
/// Portions that no thread here comes to for so long are given back.
constexpr std::chrono::seconds longest_wait{1};

std::size_t threads(const EngineCore& core) {
  return static_cast<std::size_t>(std::max(1, core.options.threads));
}

/// How many solver threads have no turn. With the lock held.
std::size_t free_threads(const EngineCore& core) {
  std::size_t busy = 0;
  for (const auto& [id, mesh] : core.meshes) busy += static_cast<std::size_t>(mesh->threads);
  return threads(core) - std::min(threads(core), busy);
}

/// Units that wait for a thread, of all jobs. With the lock held.
std::size_t waiting_here(const EngineCore& core) {
  std::size_t waiting = 0;
  for (const auto& [id, mesh] : core.meshes)
    for (const std::uint64_t units : mesh->waiting)
      waiting += mesh->mesh_operator ? static_cast<std::size_t>(units) : 0;
  return waiting;
}

/// Wakes the thread of solve_together(). With the lock held.
void wake(EngineCore& core) {
  core.spread_changed = true;
  core.spreading.notify_one();
}

std::uint64_t portions_of(const SweepPlan& plan) {
  return (plan.chunks() + plan.portion_chunks - 1) / plan.portion_chunks;
}

store::Portion portion_of(const SweepPlan& plan, std::uint64_t number) {
  const std::uint64_t rows = plan.chunk_rows * plan.portion_chunks;
  return {number, number * rows, std::min(rows, plan.rows - number * rows)};
}

/// Whether the portion has the rows that it has by this server's own plan, or is a position.
bool fits(const store::Portion& portion, const LiveJob& job) {
  if (!job.sweep)
    return job.spec->growth &&
           portion.number < job.spec->loads.size() * at(job.spec->growth->final_positions);
  const SweepPlan& plan = job.sweep->plan;
  return portion.number < portions_of(plan) && portion == portion_of(plan, portion.number);
}

/// How many more portions the threads here want. With the lock held.
std::size_t wanted(const EngineCore& core, const LiveJob& job, const LiveSpread& spread) {
  const std::size_t waiting = job.helps   ? waiting_here(core)
                              : job.sweep ? job.units - job.next_unit
                                          : spread.units.size();
  if (!job.sweep) {  // positions take long: none waits while another server may have a thread
    const std::size_t idle = job.helps ? free_threads(core) : spread.idle;
    return idle - std::min(idle, waiting);
  }
  const std::size_t most = threads(core), chunks = job.sweep->plan.portion_chunks;
  return waiting <= most ? (2 * most - waiting + chunks - 1) / chunks : 0;
}

/// Writes the portions that were solved here.
void write_solved(EngineCore& core, const JobPtr& job, LiveSpread& spread) {
  Lock lock(core.mutex);
  while (!spread.unwritten.empty()) {
    store::SolvedPortion portion{*spread.unwritten.begin(), {}};
    std::size_t first = 0, end = 0;
    if (job->sweep) {
      const LiveSweep& sweep = *job->sweep;
      first = portion.number * sweep.plan.portion_chunks;
      end = std::min(first + sweep.plan.portion_chunks, sweep.plan.chunks());
      std::vector<std::pair<SweepChunk, records::SweepRecord>> chunks;
      for (std::size_t i = first; i < end; ++i)
        chunks.emplace_back(sweep.chunks[i], spread.sums.at(i));
      lock.unlock();
      portion.body = pack(chunks, *job->spool);
    } else {
      portion.body = spread.answers.at(portion.number);
      lock.unlock();
    }
    core.queue->solved(job->id(), portion);
    lock.lock();
    spread.unwritten.erase(portion.number);
    spread.sums.erase(spread.sums.lower_bound(first), spread.sums.lower_bound(end));
  }
}

/// Takes over some of what other servers solved; returns whether there may be more.
bool fetch_solved(EngineCore& core, const JobPtr& job, LiveSpread& spread) {
  Lock lock(core.mutex);
  const std::vector<std::int64_t> missing(spread.missing.begin(), spread.missing.end());
  lock.unlock();
  const std::vector<store::SolvedPortion> portions =
      core.queue->solved_portions(job->id(), missing);
  if (portions.empty()) return false;
  for (const store::SolvedPortion& portion : portions) {
    std::vector<EndedChunk> chunks;
    if (job->sweep) chunks = unpack(portion, job);
    for (EndedChunk& chunk : chunks) {
      lock.lock();
      ++job->active;
      lock.unlock();
      core.deliver(std::move(chunk));
    }
    lock.lock();
    if (!job->sweep) spread.answers[portion.number] = portion.body;
    spread.missing.erase(portion.number);
    lock.unlock();
  }
  core.positions.notify_all();
  core.rows->publish({job});  // before so many rows push one another out of the log
  return true;
}

/// Sends what is on a list to the store, and then takes it off the list, which may have grown.
template <class Item, class Send>
void send_listed(EngineCore& core, std::vector<Item>& list, const Send& send) {
  Lock lock(core.mutex);
  const std::vector<Item> sent = list;
  if (sent.empty()) return;
  lock.unlock();
  send(sent);
  lock.lock();
  list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(sent.size()));
}

/// Offers what the store does not have yet, and takes back what is not wanted any more.
void offer(EngineCore& core, const JobPtr& job, LiveSpread& spread) {
  const int attempt = job->created.attempt;
  send_listed(core, spread.to_offer,
              [&](const auto& portions) { core.queue->spread(job->id(), attempt, portions); });
  send_listed(core, spread.to_withdraw, [&](const auto& numbers) {
    core.queue->withdraw_portions(job->id(), attempt, numbers);
  });
}

/// Takes portions for threads that will need them. Of a job that runs elsewhere it also finds out
/// whether that still wants them.
void take_more(EngineCore& core, const JobPtr& job, LiveSpread& spread, bool look) {
  Lock lock(core.mutex);
  const auto now = EngineCore::Clock::now();
  const bool served = job->active > 1;
  if (served || job->next_unit == job->units) spread.served = now;
  const bool may =
      !job->helps || ((served || free_threads(core) > 0) && now - spread.begun < help_for);
  const std::size_t count = may ? wanted(core, *job, spread) : 0;
  if (count == 0 && !(job->helps && look)) return;
  lock.unlock();
  const std::vector<store::Portion> mine = core.queue->take_portions(job->id(), count);
  lock.lock();
  if (job->why != Stop::none) return;
  const bool fit = std::ranges::all_of(mine, [&](const auto& one) { return fits(one, *job); });
  std::size_t kept = 0, added = 0;
  for (const store::Portion& one : mine) kept += spread.open.count(one.number);
  const bool lost = kept < spread.open.size();
  for (const store::Portion& one : mine) {
    if (!fit || spread.open.contains(one.number) || spread.unwritten.contains(one.number) ||
        (!job->helps && !spread.missing.contains(one.number)))
      continue;
    std::size_t units = 1, first = one.number;
    if (job->sweep) {
      const SweepPlan& plan = job->sweep->plan;
      units = (one.count + plan.chunk_rows - 1) / plan.chunk_rows;
      first *= plan.portion_chunks;
    } else {
      spread.requests[one.number] = one.request;
    }
    for (std::size_t i = 0; i < units; ++i) spread.units.push_back(first + i);
    spread.open[one.number] = units;
    added += units;
  }
  if (added > 0 && !job->helps && !job->sweep) {
    core.positions.notify_all();
  } else if (added > 0) {
    job->units += added;
    core.meshes.at(job->mesh)->waiting[index(job->lane)] += added;
    core.offer(job);
  }
  const bool asked = count > 0 || now - spread.begun > longest_wait;  // a start ends with its turn
  const bool done = asked && spread.open.empty() && spread.unwritten.empty();
  const bool starved = job->next_unit < job->units && now - spread.served > longest_wait;
  lock.unlock();
  if (!fit)
    core.stop(job, Stop::failed,
              Error(errors::Reason::internal, "another server has other portions of this job"));
  else if (job->helps && (lost || done || starved))
    core.stop(job, Stop::interrupted);
}

/// The job is not spread any more. With the lock held.
void end_spread(EngineCore& core, const JobPtr& job) {
  job->spread.reset();
  --job->active;
  core.settle(job);
}

/// Ends what this server does for a job that was stopped.
void leave(EngineCore& core, const JobPtr& job) {
  Lock lock(core.mutex);
  const Stop why = job->why;
  const auto found = core.jobs.find(job->id());
  const bool anew = found != core.jobs.end() && found->second != job;  // it has the portions
  lock.unlock();
  try {
    if (!anew) {
      if (job->helps || why == Stop::interrupted)
        core.queue->give_back_portions(job->id());
      else
        core.queue->withdraw_portions(job->id(), job->created.attempt, {});
    }
  } catch (const Error&) {
    // They go with the job, or with the lease of this server.
  }
  lock.lock();
  end_spread(core, job);
}

void attend(EngineCore& core, const JobPtr& job) {
  Lock lock(core.mutex);
  const bool runs_here = core.jobs.contains(job->id());
  const bool alone = job->helps && job->sweep && !job->spread;  // by its own limits
  if (job->why == Stop::none && job->helps && (core.draining || runs_here || alone)) {
    lock.unlock();
    core.stop(job, alone ? Stop::failed : Stop::interrupted);
    lock.lock();
  }
  if (!job->spread) return;
  LiveSpread& spread = *job->spread;
  if (job->why != Stop::none) {
    lock.unlock();
    return leave(core, job);
  }
  if (!spread.ready) return;
  const auto now = EngineCore::Clock::now();
  const bool look = now - spread.looked >= look_every;
  if (look) spread.looked = now;
  lock.unlock();
  bool more = false;  // to fetch, after the threads here have got something to do
  try {
    offer(core, job, spread);
    take_more(core, job, spread, look);
    write_solved(core, job, spread);
    more = !job->helps && look && fetch_solved(core, job, spread);
  } catch (const store::JobTaken&) {
    core.stop(job, Stop::interrupted);
  } catch (const Error& error) {
    const bool out_of_reach = error.retry_delay().count() > 0;
    if (!out_of_reach) core.stop(job, Stop::failed, error);
  }
  lock.lock();
  if (more) {
    spread.looked = {};
    wake(core);
  }
  if (!job->helps && spread.missing.empty() && job->why == Stop::none) end_spread(core, job);
}

}  // namespace

void solve_together(EngineCore& core) {
  Lock lock(core.mutex);
  while (!core.quitting) {
    std::vector<JobPtr> jobs;
    for (const auto& [number, job] : core.numbers)
      if (job->helps || job->spread) jobs.push_back(job);
    lock.unlock();
    for (const JobPtr& job : jobs) attend(core, job);
    jobs.clear();
    lock.lock();
    core.spreading.wait_for(lock, look_every, [&] {
      return core.quitting || std::exchange(core.spread_changed, false);
    });
  }
}

void help(EngineCore& core, const std::vector<std::string>& meshes_held) {
  Lock lock(core.mutex);
  const bool helps =
      std::ranges::any_of(core.numbers, [](const auto& entry) { return entry.second->helps; });
  if (core.draining || core.memory->exceeded() || helps || waiting_here(core) > 0 ||
      free_threads(core) == 0)
    return;
  const std::vector<std::string> except(core.not_helped.begin(), core.not_helped.end());
  lock.unlock();
  if (std::optional<records::JobRecord> record = core.queue->to_help(meshes_held, except))
    take_up(core, std::move(*record), "", true);
}

void begin_spread(const JobPtr& job) {
  job->spread = std::make_shared<LiveSpread>();
  ++job->active;
  if (job->helps || !job->sweep) return;
  for (std::uint64_t i = 0; i < portions_of(job->sweep->plan); ++i) {
    job->spread->to_offer.push_back(portion_of(job->sweep->plan, i));
    job->spread->missing.insert(i);
  }
}

void make_ready(EngineCore& core, LiveSpread& spread) {
  spread.ready = true;
  spread.begun = EngineCore::Clock::now();
  wake(core);
}

void note_solved(EngineCore& core, const EndedChunk& chunk) {
  const LiveJob& job = *chunk.task.job;
  LiveSpread* const spread = job.spread.get();
  if (spread == nullptr) return;
  wake(core);
  std::uint64_t number = chunk.task.index;
  if (chunk.columns) {
    spread->sums[number] = chunk.record;
    number /= job.sweep->plan.portion_chunks;
  } else if (chunk.position) {
    spread->answers[number] = *chunk.position;
  } else {
    return;
  }
  const auto open = spread->open.find(number);
  if (open == spread->open.end() || --open->second > 0) return;
  spread->open.erase(open);
  spread->missing.erase(number);
  if (job.sweep && !job.helps) {
    const std::size_t chunks = job.sweep->plan.portion_chunks;
    const auto first = spread->sums.lower_bound(number * chunks);
    const auto end = spread->sums.lower_bound((number + 1) * chunks);
    std::chrono::nanoseconds time{0};
    for (auto one = first; one != end; ++one) time += one->second.solve_time;
    if (time < worth_writing) {
      spread->sums.erase(first, end);
      spread->to_withdraw.push_back(static_cast<std::int64_t>(number));
      return;
    }
  }
  spread->unwritten.insert(number);
}

void solve_portions(EngineCore& core, const JobPtr& job,
                    const std::vector<store::Portion>& portions,
                    const std::function<void(std::size_t i, const std::string& body)>& solved) {
  if (portions.empty()) return;
  Lock lock(core.mutex);
  if (!job->spread) {
    begin_spread(job);
    make_ready(core, *job->spread);
  }
  const std::shared_ptr<LiveSpread> spread = job->spread;
  std::map<std::uint64_t, std::size_t> left;  // of `portions`: by number, those not told
  for (const store::Portion& portion : portions) {
    left.emplace(portion.number, left.size());
    spread->to_offer.push_back(portion);
    spread->missing.insert(portion.number);
  }
  lock.unlock();
  const auto is_left = [&](std::uint64_t number) { return left.contains(number); };
  const auto work = [&](std::size_t) {
    Lock of_core(core.mutex);
    try {
      while (!left.empty()) {
        if (job->why != Stop::none)
          throw Error(errors::Reason::cancelled, "stopped while solving positions of growth");
        const auto told = std::ranges::find_if(
            left, [&](const auto& one) { return spread->answers.contains(one.first); });
        const auto unit = std::ranges::find_if(spread->units, is_left);
        if (told != left.end()) {
          const std::size_t i = told->second;
          const std::string body = spread->answers.at(told->first);
          left.erase(told);
          of_core.unlock();
          solved(i, body);
          of_core.lock();
        } else if (unit != spread->units.end()) {
          const Task task{job, *unit, {}, spread->requests.at(*unit)};
          spread->units.erase(unit);
          of_core.unlock();
          const EndedChunk ended = solve_position(task, core.catalogue);
          of_core.lock();
          if (ended.failure) throw Error(*ended.failure);
          note_solved(core, ended);
        } else {
          ++spread->idle;
          wake(core);
          core.positions.wait_for(of_core, look_every);
          --spread->idle;
        }
      }
    } catch (...) {  // the other threads end as well
      if (!of_core) of_core.lock();
      std::erase_if(spread->units, is_left);
      for (const auto& [number, i] : left) {
        spread->missing.erase(number);
        spread->to_withdraw.push_back(static_cast<std::int64_t>(number));
      }
      left.clear();
      wake(core);
      throw;
    }
  };
  const int most = base::Threads::allowed();
  base::at_once(std::min(portions.size(), at(std::max(1, most))), most, [&] { return work; });
}

}  // namespace anticrack::jobs
