// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/watch_group.hpp"

#include <utility>

namespace anticrack::rpc {

WatchGroup::WatchGroup(StreamHub& hub, std::shared_ptr<jobs::EventLog> log)
    : _hub(hub), _log(std::move(log)), _target(_log->latest()) {}

void WatchGroup::start(const std::shared_ptr<WatchGroup>& group) {
  const std::weak_ptr<Wakeable> weak = group;
  group->_listener = group->_log->listen([&hub = group->_hub, weak, &log = *group->_log] {
    if (log.complete())
      hub.hurry(weak);
    else
      hub.wake(weak);
  });
  group->_hub.wake(weak);  // for events that came before the listener
}

WatchGroup::Wakes::iterator WatchGroup::join(std::function<void()> wake) {
  const std::lock_guard lock(_mutex);
  return _wakes.insert(_wakes.end(), std::move(wake));
}

void WatchGroup::leave(Wakes::iterator member) {
  const std::lock_guard lock(_mutex);
  _wakes.erase(member);
}

void WatchGroup::wake() noexcept {
  _last_round = SteadyClock::now();
  _target = _log->latest();
  const std::lock_guard lock(_mutex);
  for (const auto& member : _wakes) member();
}

std::shared_ptr<WatchGroup> WatchGroups::of(const std::shared_ptr<jobs::EventLog>& log) {
  const std::lock_guard lock(_mutex);
  if (const auto found = _groups.find(log.get()); found != _groups.end()) {
    if (auto group = found->second.lock()) return group;
  }
  std::erase_if(_groups, [](const auto& entry) { return entry.second.expired(); });
  auto group = std::make_shared<WatchGroup>(_hub, log);
  WatchGroup::start(group);
  _groups[log.get()] = group;
  return group;
}

}  // namespace anticrack::rpc
