// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/job_queue.hpp"

#include <algorithm>
#include <utility>

namespace anticrack::jobs {

void JobQueue::add(JobPtr job) {
  const std::uint64_t number = job->number;
  _waiting.emplace(number, std::move(job));
}

bool JobQueue::remove(const LiveJob& job) {
  return _waiting.erase(job.number) + _prepared.erase(job.number) > 0;
}

JobQueue::JobPtr JobQueue::next_to_prepare(Time now) {
  if (_prepared.size() + _preparing.size() >= _prepared_limit) {
    return nullptr;
  }
  const auto next = std::find_if(_waiting.begin(), _waiting.end(), [&](const auto& entry) {
    return entry.second->not_before <= now && !_preparing.contains(entry.second->spec->mesh);
  });
  if (next == _waiting.end()) {
    return nullptr;
  }
  JobPtr job = std::move(next->second);
  _waiting.erase(next);
  _preparing.insert(job->spec->mesh);
  return job;
}

void JobQueue::prepared(JobPtr job) {
  drop(*job);
  const std::uint64_t number = job->number;
  _prepared.emplace(number, std::move(job));
}

void JobQueue::prepare_again(JobPtr job, Time not_before) {
  drop(*job);
  job->not_before = not_before;
  add(std::move(job));
}

void JobQueue::drop(const LiveJob& job) {
  _preparing.erase(job.spec->mesh);
}

std::optional<JobQueue::Time> JobQueue::next_retry(Time now) const {
  std::optional<Time> earliest;
  for (const auto& [number, job] : _waiting) {
    if (job->not_before > now && (!earliest || job->not_before < *earliest)) {
      earliest = job->not_before;
    }
  }
  return earliest;
}

JobQueue::JobPtr JobQueue::next_to_start(
    const std::function<Operator(const std::string& mesh)>& find) {
  std::set<std::string> not_ready;
  const std::uint64_t bound = _prepared.empty() ? UINT64_MAX : _prepared.begin()->first;
  for (auto entry = _waiting.begin(); entry != _waiting.end() && entry->first < bound; ++entry) {
    const std::string& mesh = entry->second->spec->mesh;
    if (not_ready.contains(mesh)) {
      continue;
    }
    if (Operator mesh_operator = find(mesh)) {
      JobPtr job = std::move(entry->second);
      _waiting.erase(entry);
      job->mesh_operator = std::move(mesh_operator);
      return job;
    }
    not_ready.insert(mesh);
  }
  if (_prepared.empty()) {
    return nullptr;
  }
  JobPtr job = std::move(_prepared.begin()->second);
  _prepared.erase(_prepared.begin());
  return job;
}

}  // namespace anticrack::jobs
