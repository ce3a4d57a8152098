// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/stream_hub.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

std::chrono::milliseconds tick_interval(const StreamLimits& limits) {
  const auto shortest = std::min(limits.heartbeat, limits.stall) / 4;
  return std::clamp(shortest, std::chrono::milliseconds(5), std::chrono::milliseconds(1000));
}

}  // namespace

StreamHub::StreamHub(StreamLimits limits) : _limits(limits), _thread([this] { run(); }) {}

StreamHub::~StreamHub() {
  {
    const std::lock_guard lock(_mutex);
    _stopping = true;
  }
  _changed.notify_all();
  _thread.join();
}

void StreamHub::add(StreamKind kind, const std::shared_ptr<Stream>& stream) {
  const std::lock_guard lock(_mutex);
  if (_closed) throw draining_error();
  int& count = kind == StreamKind::watch ? _watchers : _transfers;
  const int limit = kind == StreamKind::watch ? _limits.watchers : _limits.transfers;
  if (count >= limit) {
    throw Error(Reason::busy, std::string(kind == StreamKind::watch ? "watches" : "transfers") +
                                  " open: " + std::to_string(count) +
                                  ", as many as this server allows; try again later")
        .retry_after(std::chrono::seconds(1));
  }
  _entries.emplace(stream.get(), Entry{kind, stream});
  ++count;
}

void StreamHub::remove(const Stream& stream) noexcept {
  {
    const std::lock_guard lock(_mutex);
    const auto entry = _entries.find(&stream);
    if (entry == _entries.end()) return;
    --(entry->second.kind == StreamKind::watch ? _watchers : _transfers);
    _entries.erase(entry);
  }
  _changed.notify_all();
}

void StreamHub::wake(const std::weak_ptr<Stream>& stream) {
  const std::shared_ptr<Stream> target = stream.lock();
  if (!target || target->_queued.exchange(true)) return;
  {
    const std::lock_guard lock(_mutex);
    _woken.push_back(stream);
  }
  _changed.notify_all();
}

void StreamHub::close() {
  const std::lock_guard lock(_mutex);
  _closed = true;
}

void StreamHub::drain(const Error& error, std::chrono::milliseconds patience,
                      SteadyClock::time_point deadline) {
  close();
  for (const auto& stream : streams()) stream->end(error);
  if (wait_until_empty(std::min(SteadyClock::now() + patience, deadline))) return;
  for (const auto& stream : streams()) stream->abort();
  wait_until_empty(deadline);
}

int StreamHub::watchers() const {
  const std::lock_guard lock(_mutex);
  return _watchers;
}

std::vector<std::shared_ptr<Stream>> StreamHub::streams() const {
  std::vector<std::shared_ptr<Stream>> result;
  const std::lock_guard lock(_mutex);
  result.reserve(_entries.size());
  for (const auto& [key, entry] : _entries) {
    if (auto stream = entry.stream.lock()) result.push_back(std::move(stream));
  }
  return result;
}

bool StreamHub::wait_until_empty(SteadyClock::time_point deadline) {
  std::unique_lock lock(_mutex);
  return _changed.wait_until(lock, deadline, [this] { return _entries.empty(); });
}

void StreamHub::run() {
  const auto interval = tick_interval(_limits);
  auto next_tick = SteadyClock::now() + interval;
  for (;;) {
    std::deque<std::weak_ptr<Stream>> woken;
    {
      std::unique_lock lock(_mutex);
      _changed.wait_until(lock, next_tick, [this] { return _stopping || !_woken.empty(); });
      if (_stopping) return;
      woken.swap(_woken);
    }
    for (const auto& entry : woken) {
      if (const auto stream = entry.lock()) {
        stream->_queued = false;  // before the wake: what comes meanwhile is not lost
        stream->wake();
      }
    }
    const auto now = SteadyClock::now();
    if (now < next_tick) continue;
    next_tick = now + interval;
    for (const auto& stream : streams()) stream->tick(now);
  }
}

Error draining_error() {
  return Error(Reason::draining, "the server is stopping; try again in a moment, or elsewhere")
      .retry_after(std::chrono::seconds(1));
}

}  // namespace anticrack::rpc
