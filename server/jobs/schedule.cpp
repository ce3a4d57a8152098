// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/schedule.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace anticrack::jobs {

namespace {

using meshes::class_of;
using meshes::Last;
using meshes::last_of;

constexpr int nothing = std::numeric_limits<int>::max();

}  // namespace

bool Schedule::Work::empty() const {
  return std::all_of(jobs.begin(), jobs.end(),
                     [](const auto& waiting) { return waiting.empty(); }) &&
         std::all_of(parked.begin(), parked.end(), [](int count) { return count == 0; });
}

bool Schedule::Mesh::empty() const {
  return std::all_of(lanes.begin(), lanes.end(), [](const Work& work) { return work.empty(); });
}

int Schedule::urgency(const Work& work, Time begin, Time now) {
  int best = nothing;
  for (std::size_t priority = 0; priority < work.jobs.size(); ++priority) {
    if (work.parked[priority] > 0) best = std::min(best, meshes::urgency(priority, begin, now));
    for (const auto& [owner, jobs] : work.jobs[priority])
      best = std::min(best, meshes::urgency(priority, std::max(jobs.begin()->second, begin), now));
  }
  return best;
}

std::optional<Schedule::Place> Schedule::first(const Work& work, Time now) {
  std::optional<Place> best;
  for (std::size_t priority = 0; priority < work.jobs.size(); ++priority) {
    for (const auto& [owner, jobs] : work.jobs[priority]) {
      const auto& [number, since] = *jobs.begin();
      const Last last = last_of(work.taken, owner);
      const Place place{meshes::urgency(priority, std::max(since, last.time), now), last.number,
                        meshes::urgency(priority, since, now), number};
      best = best ? std::min(*best, place) : place;
    }
  }
  return best;
}

void Schedule::add(const Waiting& job) {
  _jobs[job.number] = job;
  Mesh& mesh = _meshes[job.mesh];
  mesh.owner = job.owner;
  mesh.lanes[index(job.lane)].jobs[class_of(job.priority)][job.owner].emplace(job.number,
                                                                              job.since);
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
  const std::optional<Place> place = first(work, now);
  return place ? std::optional(place->number) : std::nullopt;
}

void Schedule::taken(std::uint64_t number, Time now) {
  const Waiting& job = _jobs.at(number);
  _meshes.at(job.mesh).lanes[index(job.lane)].taken[job.owner] = {now, ++_turns};
}

std::optional<records::Priority> Schedule::most_urgent(const std::string& mesh, Lane lane) const {
  const auto found = _meshes.find(mesh);
  if (found != _meshes.end()) {
    const auto& jobs = found->second.lanes[index(lane)].jobs;
    for (std::size_t priority = 0; priority < jobs.size(); ++priority)
      if (!jobs[priority].empty())
        return static_cast<records::Priority>(
            static_cast<std::size_t>(records::Priority::interactive) + priority);
  }
  return std::nullopt;
}

void Schedule::park(const std::string& mesh, Lane lane, records::Priority priority) {
  ++_meshes[mesh].lanes[index(lane)].parked[class_of(priority)];
}

void Schedule::unpark(const std::string& mesh, Lane lane, records::Priority priority) {
  --_meshes.at(mesh).lanes[index(lane)].parked[class_of(priority)];
}

void Schedule::let_go(const std::string& mesh) {
  _meshes[mesh].ready = false;
  forget_if_empty(mesh);
}

void Schedule::forget_if_empty(const std::string& mesh) {
  const auto found = _meshes.find(mesh);
  if (found == _meshes.end() || !found->second.empty()) return;
  if (!found->second.ready) _meshes.erase(found);
}

bool Schedule::has_turns(const std::string& id, const Mesh& mesh, const Excluded& excluded) {
  return mesh.ready && !(excluded && excluded(id, mesh.owner));
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
        best = Turn{id, static_cast<Lane>(lane), mesh.owner};
        best_key = key;
      }
    }
  }
  Mesh& mesh = _meshes.at(best->mesh);
  mesh.served = now;
  mesh.last_turn = mesh.lanes[index(best->lane)].last_turn = ++_turns;
  _served[*owner] = {now, _turns};
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
    if (!entry.ready) continue;
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
