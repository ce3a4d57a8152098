// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/stream_hub.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "access/share.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

/// A round that wakes more than this many is followed by an equally long rest. So a crowd of
/// watches takes at most half a processor, however fast the job is, and solvers have the rest.
constexpr std::size_t crowd = 64;

std::chrono::milliseconds tick_interval(const StreamLimits& limits) {
  const auto shortest = std::min(limits.heartbeat, limits.stall) / 4;
  return std::clamp(shortest, std::chrono::milliseconds(5), std::chrono::milliseconds(1000));
}

Error full(const std::string& what) {
  return Error(Reason::busy, "{}; try again later", what).retry_after(std::chrono::seconds(1));
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

void StreamHub::add(StreamKind kind, const std::string& client,
                    const std::shared_ptr<Stream>& stream) {
  const std::lock_guard lock(_mutex);
  if (_closed) throw draining_error();
  const int count = count_of(kind);
  if (count >= (kind == StreamKind::watch ? _limits.watchers : _limits.transfers)) {
    throw full(fmt::format("{} open: {}, as many as this server allows",
                           kind == StreamKind::watch ? "watches" : "transfers", count));
  }
  const auto found = _clients.find(client);
  const Open held = found == _clients.end() ? Open{} : found->second;
  if (held.streams >= _limits.a_client) {
    throw full(fmt::format(
        "you have {} watches and transfers open, as many as this server allows a client",
        held.streams));
  }
  if (kind == StreamKind::transfer &&
      !access::may_have(held.transfers, 1, count, _limits.transfers)) {
    throw full(fmt::format("you have {} transfers open, one client may have {} now", held.transfers,
                           access::share(held.transfers, count, _limits.transfers)));
  }
  _entries.emplace(stream.get(), Entry{kind, client, stream});
  Open& open = _clients[client];
  ++open.streams;
  open.transfers += kind == StreamKind::transfer ? 1 : 0;
  ++count_of(kind);
}

void StreamHub::remove(const Stream& stream) noexcept {
  {
    const std::lock_guard lock(_mutex);
    const auto entry = _entries.find(&stream);
    if (entry == _entries.end()) return;
    --count_of(entry->second.kind);
    const auto client = _clients.find(entry->second.client);
    client->second.transfers -= entry->second.kind == StreamKind::transfer ? 1 : 0;
    if (--client->second.streams == 0) _clients.erase(client);
    _entries.erase(entry);
  }
  _changed.notify_all();
}

void StreamHub::wake(const std::weak_ptr<Wakeable>& target) {
  const std::shared_ptr<Wakeable> held = target.lock();
  if (!held || held->_queued.exchange(true)) return;
  {
    const std::lock_guard lock(_mutex);
    _woken.push_back(target);
  }
  _changed.notify_all();
}

void StreamHub::hurry(const std::weak_ptr<Wakeable>& target) {
  wake(target);
  {
    const std::lock_guard lock(_mutex);
    _hurry = true;
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

StreamCounts StreamHub::counts() const {
  const std::lock_guard lock(_mutex);
  return _counts;
}

std::uint64_t StreamHub::largest_lag() const {
  std::uint64_t largest = 0;
  for (const auto& stream : streams()) largest = std::max(largest, stream->lag());
  return largest;
}

std::vector<std::shared_ptr<Stream>> StreamHub::streams() const {
  std::vector<std::shared_ptr<Stream>> result;
  const std::lock_guard lock(_mutex);
  result.reserve(_entries.size());
  for (const auto& [key, entry] : _entries)
    if (auto stream = entry.stream.lock()) result.push_back(std::move(stream));
  return result;
}

bool StreamHub::wait_until_empty(SteadyClock::time_point deadline) {
  std::unique_lock lock(_mutex);
  return _changed.wait_until(lock, deadline, [this] { return _entries.empty(); });
}

void StreamHub::run() {
  const auto interval = tick_interval(_limits);
  auto next_tick = SteadyClock::now() + interval;
  auto next_late = SteadyClock::time_point::max();
  std::vector<std::weak_ptr<Wakeable>> late;  // targets whose time has not come
  for (;;) {
    std::vector<std::weak_ptr<Wakeable>> woken;
    bool hurry = false;
    {
      std::unique_lock lock(_mutex);
      _changed.wait_until(lock, std::min(next_tick, next_late),
                          [this] { return _stopping || _hurry || !_woken.empty(); });
      if (_stopping) return;
      woken.swap(_woken);
      hurry = std::exchange(_hurry, false);
    }
    auto now = SteadyClock::now();
    if (hurry || now >= next_late) {
      woken.insert(woken.end(), late.begin(), late.end());
      late.clear();
      next_late = SteadyClock::time_point::max();
    }
    for (auto& entry : woken) {
      const auto target = entry.lock();
      if (!target) continue;
      if (const auto time = target->not_before(); time > now) {
        next_late = std::min(next_late, time);
        late.push_back(std::move(entry));
        continue;
      }
      target->_queued = false;  // before the wake, so that a request during it is not lost
      target->wake();
    }
    const auto began = std::exchange(now, SteadyClock::now());
    if (woken.size() > crowd) {
      std::unique_lock lock(_mutex);
      _changed.wait_until(lock, now + (now - began), [this] { return _stopping; });
      now = SteadyClock::now();
    }
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
