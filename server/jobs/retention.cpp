// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/retention.hpp"

#include <algorithm>
#include <utility>

namespace anticrack::jobs {

namespace {

auto find(auto& jobs, const std::string& id) {
  return std::find_if(jobs.begin(), jobs.end(), [&](const auto& job) { return job.id == id; });
}

}  // namespace

void Retention::add(store::EndedJob job) {
  _bytes += job.result_bytes;
  const auto place =
      std::upper_bound(_jobs.begin(), _jobs.end(), job,
                       [](const auto& a, const auto& b) { return a.ended < b.ended; });
  _jobs.insert(place, std::move(job));
}

void Retention::remove(const std::string& id) {
  const auto found = find(_jobs, id);
  if (found != _jobs.end()) {
    _bytes -= found->result_bytes;
    _jobs.erase(found);
  }
}

void Retention::expired(const std::string& id) {
  const auto found = find(_jobs, id);
  if (found != _jobs.end()) _bytes -= std::exchange(found->result_bytes, 0);
}

Expiry Retention::due(store::Clock::time_point now) const {
  Expiry expiry;
  std::uint64_t bytes = _bytes;
  const std::size_t kept = std::max<std::size_t>(1, _limits.jobs);
  const auto newest = std::find_if(_jobs.rbegin(), _jobs.rend(),
                                   [](const auto& job) { return job.result_bytes > 0; });
  for (std::size_t i = 0; i < _jobs.size(); ++i) {
    const store::EndedJob& job = _jobs[i];
    if (_jobs.size() - i > kept) {
      expiry.erase.push_back(job.id);
      bytes -= job.result_bytes;
      continue;
    }
    if (job.result_bytes == 0) continue;
    const bool old = _limits.ttl.count() > 0 && now - job.ended >= _limits.ttl;
    if (old || (bytes > _limits.bytes && &job != &*newest)) {
      expiry.expire.push_back(job.id);
      bytes -= job.result_bytes;
    }
  }
  return expiry;
}

}  // namespace anticrack::jobs
