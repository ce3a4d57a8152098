// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/schedule.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace anticrack::jobs {

namespace {

constexpr int nothing = std::numeric_limits<int>::max();

constexpr std::size_t most_urgent_class = static_cast<std::size_t>(store::Priority::interactive);

std::size_t class_of(store::Priority priority) {
  return static_cast<std::size_t>(priority) - most_urgent_class;
}

}  // namespace

bool Schedule::Work::empty() const {
  return std::all_of(jobs.begin(), jobs.end(),
                     [](const auto& waiting) { return waiting.empty(); }) &&
         std::all_of(parked.begin(), parked.end(), [](int count) { return count == 0; });
}

bool Schedule::Mesh::empty() const {
  return std::all_of(lanes.begin(), lanes.end(), [](const Work& work) { return work.empty(); });
}

int Schedule::urgency(std::size_t priority, Time since, Time now) const {
  const auto waited = std::chrono::duration_cast<std::chrono::milliseconds>(now - since);
  const auto aged = _ageing.count() > 0 ? waited / _ageing : std::int64_t{0};
  return static_cast<int>(std::max<std::int64_t>(0, static_cast<std::int64_t>(priority) - aged));
}

int Schedule::urgency(const Work& work, Time begin, Time now) const {
  int best = nothing;
  for (std::size_t priority = 0; priority < work.jobs.size(); ++priority) {
    if (work.parked[priority] > 0) best = std::min(best, urgency(priority, begin, now));
    for (const auto& [owner, jobs] : work.jobs[priority])
      best = std::min(best, urgency(priority, std::max(jobs.begin()->second, begin), now));
  }
  return best;
}

std::optional<Schedule::Place> Schedule::first(const Work& work, const Lasts& lasts,
                                               Time now) const {
  std::optional<Place> best;
  for (std::size_t priority = 0; priority < work.jobs.size(); ++priority) {
    for (const auto& [owner, jobs] : work.jobs[priority]) {
      const auto& [number, since] = *jobs.begin();
      const Last last = last_of(lasts, owner);
      const Place place{urgency(priority, std::max(since, last.time), now), last.number,
                        urgency(priority, since, now), number};
      best = best ? std::min(*best, place) : place;
    }
  }
  return best;
}

Schedule::Last Schedule::last_of(const Lasts& lasts, const std::string& owner) {
  const auto found = lasts.find(owner);
  return found == lasts.end() ? Last{} : found->second;
}

void Schedule::add(const Waiting& job) {
  _jobs[job.number] = job;
  Mesh& mesh = _meshes[job.mesh];
  mesh.size_class = job.size_class;
  mesh.owner = job.owner;
  mesh.lanes[index(job.lane)].jobs[class_of(job.priority)][job.owner].emplace(job.number,
                                                                              job.since);
  if (mesh.stage == Stage::absent) mesh.stage = Stage::unknown;  // it may have come meanwhile
}

void Schedule::remove(std::uint64_t number) {
  const auto found = _jobs.find(number);
  if (found == _jobs.end()) return;
  const Waiting job = found->second;
  _jobs.erase(found);
  auto& waiting = _meshes.at(job.mesh).lanes[index(job.lane)].jobs[class_of(job.priority)];
  const auto own = waiting.find(job.owner);
  own->second.erase(number);
  if (own->second.empty()) waiting.erase(own);
  forget_if_empty(job.mesh);
}

std::optional<std::uint64_t> Schedule::next_job(const std::string& mesh, Lane lane,
                                                Time now) const {
  const auto found = _meshes.find(mesh);
  if (found == _meshes.end()) return std::nullopt;
  const Work& work = found->second.lanes[index(lane)];
  const std::optional<Place> place = first(work, work.taken, now);
  return place ? std::optional(place->number) : std::nullopt;
}

void Schedule::taken(std::uint64_t number, Time now) {
  const Waiting& job = _jobs.at(number);
  _meshes.at(job.mesh).lanes[index(job.lane)].taken[job.owner] = {now, ++_turns};
}

std::optional<store::Priority> Schedule::most_urgent(const std::string& mesh, Lane lane) const {
  const auto found = _meshes.find(mesh);
  if (found != _meshes.end()) {
    const auto& jobs = found->second.lanes[index(lane)].jobs;
    for (std::size_t priority = 0; priority < jobs.size(); ++priority)
      if (!jobs[priority].empty())
        return static_cast<store::Priority>(most_urgent_class + priority);
  }
  return std::nullopt;
}

void Schedule::park(const std::string& mesh, Lane lane, store::Priority priority) {
  ++_meshes[mesh].lanes[index(lane)].parked[class_of(priority)];
}

void Schedule::unpark(const std::string& mesh, Lane lane, store::Priority priority) {
  --_meshes.at(mesh).lanes[index(lane)].parked[class_of(priority)];
}

std::map<int, Schedule::Ahead> Schedule::prepared_ahead() const {
  std::map<int, Ahead> count;
  for (const auto& [id, mesh] : _meshes) {
    if (mesh.stage == Stage::preparing || (mesh.stage == Stage::ready && mesh.unused)) {
      Ahead& ahead = count[mesh.size_class];
      ++ahead.all;
      ++ahead.of_owner[mesh.owner];
    }
  }
  return count;
}

bool Schedule::may_prepare(const Ahead& ahead, const std::string& owner) const {
  const bool newcomer = !owner.empty() && !ahead.of_owner.contains(owner);
  return ahead.all < (newcomer ? 2 : 1) * _prepared_limit;
}

std::optional<std::string> Schedule::next_to_prepare(Time now) {
  std::map<int, Ahead> ahead = prepared_ahead();
  Mesh* best = nullptr;
  const std::string* name = nullptr;
  std::optional<Place> best_place;
  for (auto& [id, mesh] : _meshes) {
    const bool waits = mesh.stage == Stage::unknown || mesh.stage == Stage::absent;
    if (!waits || mesh.not_before > now || !may_prepare(ahead[mesh.size_class], mesh.owner))
      continue;
    for (const Work& work : mesh.lanes) {
      const std::optional<Place> place = first(work, _prepared, now);
      if (place && (!best_place || *place < *best_place)) {
        best = &mesh;
        name = &id;
        best_place = place;
      }
    }
  }
  if (best == nullptr) return std::nullopt;
  best->stage = Stage::preparing;
  _prepared[_jobs.at(best_place->number).owner] = {now, ++_preparations};
  return *name;
}

void Schedule::prepared(const std::string& mesh) {
  Mesh& entry = _meshes[mesh];
  entry.unused = entry.stage == Stage::preparing;
  entry.stage = Stage::ready;
}

void Schedule::again(const std::string& mesh, Time not_before) {
  Mesh& entry = _meshes[mesh];
  entry.stage = Stage::absent;
  entry.not_before = not_before;
  forget_if_empty(mesh);
}

void Schedule::absent(const std::string& mesh) {
  _meshes[mesh].stage = Stage::absent;
  forget_if_empty(mesh);
}

void Schedule::let_go(const std::string& mesh) {
  _meshes[mesh].stage = Stage::unknown;
  forget_if_empty(mesh);
}

void Schedule::forget_if_empty(const std::string& mesh) {
  const auto found = _meshes.find(mesh);
  if (found == _meshes.end() || !found->second.empty()) return;
  const Stage stage = found->second.stage;
  if (stage == Stage::unknown || stage == Stage::absent) _meshes.erase(found);
}

std::optional<Schedule::Time> Schedule::next_retry(Time now) const {
  std::optional<Time> earliest;
  for (const auto& [id, mesh] : _meshes)
    if (mesh.not_before > now && (!earliest || mesh.not_before < *earliest))
      earliest = mesh.not_before;
  return earliest;
}

bool Schedule::has_turns(const std::string& id, const Mesh& mesh, const Excluded& excluded) {
  return mesh.has_turns() && !(excluded && excluded(id, mesh.owner));
}

std::optional<std::string> Schedule::next_owner(Time now, const Excluded& excluded) const {
  std::pair<int, std::uint64_t> best_key;
  std::optional<std::string> best;
  for (const auto& [id, mesh] : _meshes) {
    if (!has_turns(id, mesh, excluded)) continue;
    const Last last = last_of(_served, mesh.owner);
    for (const Work& work : mesh.lanes) {
      const int urgent = urgency(work, std::max(mesh.served, last.time), now);
      const std::pair key{urgent, last.number};
      if (urgent != nothing && (!best || key < best_key)) {
        best = mesh.owner;
        best_key = key;
      }
    }
  }
  return best;
}

std::optional<Turn> Schedule::next_turn(Time now, const Excluded& excluded) {
  const std::optional<std::string> owner = next_owner(now, excluded);
  if (!owner) return std::nullopt;
  std::tuple<int, std::uint64_t, std::uint64_t> best_key;
  std::optional<Turn> best;
  for (const auto& [id, mesh] : _meshes) {
    if (mesh.owner != *owner || !has_turns(id, mesh, excluded)) continue;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const Work& work = mesh.lanes[lane];
      const int urgent = urgency(work, mesh.served, now);
      const std::tuple key{urgent, mesh.last_turn, work.last_turn};
      if (urgent != nothing && (!best || key < best_key)) {
        best = Turn{id, static_cast<Lane>(lane), mesh.stage == Stage::unknown, mesh.owner};
        best_key = key;
      }
    }
  }
  Mesh& mesh = _meshes.at(best->mesh);
  if (best->probe) {
    mesh.stage = Stage::looking;
  } else {
    mesh.unused = false;
    mesh.served = now;
    mesh.last_turn = mesh.lanes[index(best->lane)].last_turn = ++_turns;
    _served[*owner] = {now, _turns};
  }
  return best;
}

void Schedule::served(const std::string& mesh, Time now) {
  const auto found = _meshes.find(mesh);
  if (found == _meshes.end()) return;
  found->second.served = now;
  _served[found->second.owner].time = now;
}

bool Schedule::others(const std::string& mesh, Lane lane) const {
  for (const auto& [id, entry] : _meshes) {
    if (!entry.has_turns()) continue;
    for (std::size_t i = 0; i < lane_count; ++i) {
      const Work& work = entry.lanes[i];
      const bool own = id == mesh && static_cast<Lane>(i) == lane;
      const bool there =
          own ? std::any_of(work.parked.begin(), work.parked.end(), [](int n) { return n > 0; })
              : !work.empty();
      if (there) return true;
    }
  }
  return false;
}

}  // namespace anticrack::jobs
