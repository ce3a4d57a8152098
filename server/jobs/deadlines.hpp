// SPDX-License-Identifier: GPL-3.0-or-later
//
// The times at which something of a job is due, without threads or locks.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace anticrack::jobs {

enum class Due {
  queue_time,  ///< the job has waited as long as it may
  run_time,    ///< the job has run as long as it may
  start,       ///< the job's start failed and is to be tried again
};

/// At most one time of each kind for each job; jobs are given by their numbers. Not thread-safe.
class Deadlines {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Entry = std::pair<std::uint64_t, Due>;

  /// Sets the time of a job and kind, in place of the old one.
  void set(std::uint64_t job, Due due, Time time) {
    clear(job, due);
    _times.emplace(Entry{job, due}, time);
    _order.emplace(time, Entry{job, due});
  }
  /// Does nothing if there is none.
  void clear(std::uint64_t job, Due due) {
    const auto found = _times.find({job, due});
    if (found != _times.end()) {
      _order.erase({found->second, found->first});
      _times.erase(found);
    }
  }
  /// Clears all times of a job.
  void clear(std::uint64_t job) {
    for (const Due due : {Due::queue_time, Due::run_time, Due::start}) clear(job, due);
  }

  /// The earliest time of all; none if there are no times.
  std::optional<Time> next() const {
    return _order.empty() ? std::nullopt : std::optional<Time>(_order.begin()->first);
  }
  /// Takes out all that is due at `now`, the earliest first.
  std::vector<Entry> take(Time now) {
    std::vector<Entry> due;
    while (!_order.empty() && _order.begin()->first <= now) {
      due.push_back(_order.begin()->second);
      _times.erase(_order.begin()->second);
      _order.erase(_order.begin());
    }
    return due;
  }

 private:
  std::map<Entry, Time> _times;
  std::set<std::pair<Time, Entry>> _order;
};

}  // namespace anticrack::jobs
