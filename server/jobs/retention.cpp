// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/retention.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace anticrack::jobs {

namespace {

auto find(auto& jobs, const std::string& id) {
  return std::find_if(jobs.begin(), jobs.end(), [&](const auto& job) { return job.id == id; });
}

/// The jobs of one owner, the oldest first.
struct Holdings {
  std::deque<const store::EndedJob*> jobs;
  std::deque<const store::EndedJob*> results;
  std::uint64_t bytes = 0;  ///< bytes of the results
};

using Jobs = std::deque<const store::EndedJob*>;

/// The owner with the most in `jobs`; among equals, the one whose oldest job ended first.
Holdings& most(std::map<std::string, Holdings>& owners, Jobs Holdings::*jobs, const auto& measure) {
  const auto less = [&](const auto& a, const auto& b) {
    const Jobs &mine = a.second.*jobs, &others = b.second.*jobs;
    if (mine.empty() || others.empty()) return !others.empty();
    const auto difference = measure(a.second) <=> measure(b.second);
    return difference != 0 ? difference < 0 : mine.front()->ended > others.front()->ended;
  };
  return std::ranges::max_element(owners, less)->second;
}

}  // namespace

void Retention::add(store::EndedJob job) {
  const auto place =
      std::upper_bound(_jobs.begin(), _jobs.end(), job,
                       [](const auto& a, const auto& b) { return a.ended < b.ended; });
  _jobs.insert(place, std::move(job));
}

void Retention::remove(const std::string& id) {
  const auto found = find(_jobs, id);
  if (found != _jobs.end()) _jobs.erase(found);
}

void Retention::expired(const std::string& id) {
  const auto found = find(_jobs, id);
  if (found != _jobs.end()) found->result_bytes = 0;
}

Expiry Retention::due(records::Clock::time_point now) const {
  Expiry expiry;
  std::map<std::string, Holdings> owners;
  std::uint64_t bytes = 0;
  const auto newest = std::find_if(_jobs.rbegin(), _jobs.rend(),
                                   [](const auto& job) { return job.result_bytes > 0; });
  for (const store::EndedJob& job : _jobs) {
    Holdings& owner = owners[job.owner];
    owner.jobs.push_back(&job);
    if (job.result_bytes == 0) continue;
    owner.results.push_back(&job);
    owner.bytes += job.result_bytes;
    bytes += job.result_bytes;
  }
  const auto give_up_oldest_result = [&](Holdings& owner) {
    owner.bytes -= owner.results.front()->result_bytes;
    bytes -= owner.results.front()->result_bytes;
    owner.results.pop_front();
  };
  const std::size_t kept = std::max<std::size_t>(1, _limits.jobs);
  for (std::size_t count = _jobs.size(); count > kept; --count) {
    Holdings& owner =
        most(owners, &Holdings::jobs, [](const Holdings& of) { return of.jobs.size(); });
    const store::EndedJob* job = owner.jobs.front();
    owner.jobs.pop_front();
    expiry.erase.push_back(job->id);
    if (job->result_bytes > 0) give_up_oldest_result(owner);
  }
  const auto old = [&](const store::EndedJob& job) {
    return _limits.ttl.count() > 0 && now - job.ended >= _limits.ttl;
  };
  for (auto& [name, owner] : owners) {
    while (!owner.results.empty() && old(*owner.results.front())) {
      expiry.expire.push_back(owner.results.front()->id);
      give_up_oldest_result(owner);
    }
  }
  if (newest != _jobs.rend()) {  // the newest result stays
    Holdings& owner = owners[newest->owner];
    if (!owner.results.empty() && owner.results.back() == &*newest) {
      owner.results.pop_back();
      owner.bytes -= newest->result_bytes;
    }
  }
  while (bytes > _limits.bytes) {
    Holdings& owner = most(owners, &Holdings::results, [](const Holdings& of) { return of.bytes; });
    if (owner.results.empty()) break;
    expiry.expire.push_back(owner.results.front()->id);
    give_up_oldest_result(owner);
  }
  return expiry;
}

}  // namespace anticrack::jobs
