// SPDX-License-Identifier: GPL-3.0-or-later
//
// All watches of one job, behind one listener: an event costs the job's thread one flag, however
// many watch.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "jobs/event_log.hpp"
#include "rpc/stream_hub.hpp"

namespace anticrack::rpc {

/// Works in rounds on the hub's thread, `pace` apart: a round notes how far the log is and wakes
/// the members, who send events up to there. So many samples of a fast job go into one message. The
/// last round, after the job's end, does not wait. Thread-safe.
class WatchGroup final : public Wakeable {
 public:
  static constexpr std::chrono::milliseconds pace{10};
  using Wakes = std::list<std::function<void()>>;

  /// The group of the job with this log.
  WatchGroup(StreamHub& hub, std::shared_ptr<jobs::EventLog> log);

  /// Begins to listen; to be called once, before anybody joins.
  static void start(const std::shared_ptr<WatchGroup>& group);

  /// Adds a member. `wake` is called in each round until leave(); it must be quick, and not call
  /// these.
  Wakes::iterator join(std::function<void()> wake);
  void leave(Wakes::iterator member);

  /// Events up to here may be sent.
  std::uint64_t target() const noexcept { return _target; }
  const jobs::EventLog& log() const noexcept { return *_log; }

  void wake() noexcept override;
  SteadyClock::time_point not_before() const noexcept override {
    return _log->complete() ? SteadyClock::time_point{} : _last_round + pace;
  }

 private:
  StreamHub& _hub;
  const std::shared_ptr<jobs::EventLog> _log;
  std::atomic<std::uint64_t> _target;
  SteadyClock::time_point _last_round{};  ///< used by the hub's thread only
  std::mutex _mutex;                      ///< lock order: group before hub
  Wakes _wakes;
  std::shared_ptr<jobs::EventLog::Listener> _listener;
};

/// The groups; each exists as long as it has a watcher. Thread-safe.
class WatchGroups {
 public:
  explicit WatchGroups(StreamHub& hub) : _hub(hub) {}
  /// The group of a log; a new one for the first watcher.
  std::shared_ptr<WatchGroup> of(const std::shared_ptr<jobs::EventLog>& log);

 private:
  StreamHub& _hub;
  std::mutex _mutex;
  std::unordered_map<const jobs::EventLog*, std::weak_ptr<WatchGroup>> _groups;
};

}  // namespace anticrack::rpc
