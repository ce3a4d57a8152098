// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/event_log.hpp"

#include <algorithm>
#include <deque>
#include <mutex>
#include <utility>

#include "errors/errors.hpp"
#include "jobs/sample_queue.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

/// A wake function that can be switched off. The recursive mutex makes switching off wait for a
/// call on another thread, but not for the call it comes from.
struct Wake {
  explicit Wake(std::function<void()> function) : call(std::move(function)) {}

  void operator()() {
    const std::lock_guard lock(mutex);
    if (call && active) {
      call();
    }
  }

  void close() {
    const std::lock_guard lock(mutex);
    active = false;
  }

  std::recursive_mutex mutex;
  bool active = true;
  const std::function<void()> call;
};

using Wakes = std::vector<std::shared_ptr<Wake>>;

/// Any event but a sample: rare, so it is kept as it is, with its number.
struct Kept {
  NumberedEvent numbered;
  std::size_t bytes = 0;
};

std::size_t bytes_of(const Event& event) {
  std::size_t bytes = sizeof(Kept);
  if (const auto* phase = std::get_if<PhaseEvent>(&event)) {
    bytes += phase->detail.size();
  } else if (const auto* ended = std::get_if<CaseEvent>(&event)) {
    const store::CaseRecord& record = *ended->record;
    bytes += sizeof(record) + record.answer.reason.size() +
             record.answer.inclusions.size() * sizeof(contact::InclusionAnswer) +
             record.answer.contact_intervals.size() * sizeof(contact::ContactInterval);
  }
  return bytes;
}

Error trimmed(std::uint64_t after, std::uint64_t earliest, std::uint64_t latest) {
  const std::string range =
      "the log holds " + std::to_string(earliest) + " to " + std::to_string(latest);
  Error error(Reason::sequence_trimmed,
              after > latest ? "there is no event " + std::to_string(after) + " yet: " + range
                             : "event " + std::to_string(after + 1) + " is no longer kept: " +
                                   range + "; continue after " + std::to_string(earliest - 1));
  return error.with("earliest_sequence", std::to_string(earliest))
      .with("latest_sequence", std::to_string(latest));
}

}  // namespace

struct EventLog::State {
  State(std::size_t limit, std::uint64_t base)
      : byte_limit(limit), earliest(base + 1), latest(base) {}

  const std::size_t byte_limit;

  mutable std::mutex mutex;
  SampleQueue samples;
  std::deque<Kept> others;
  std::size_t other_bytes = 0;
  std::uint64_t earliest;
  std::uint64_t latest;
  bool ended = false;
  /// Replaced, never changed, so that the writer can walk it without the lock.
  std::shared_ptr<const Wakes> wakes = std::make_shared<const Wakes>();

  std::size_t bytes() const { return samples.size() * SampleQueue::bytes_per_sample + other_bytes; }

  void trim() {
    // The newest event stays whatever its size: the end event is always the newest.
    while (bytes() > byte_limit && earliest < latest) {
      if (!others.empty() && others.front().numbered.sequence == earliest) {
        other_bytes -= others.front().bytes;
        others.pop_front();
      } else {
        samples.pop_front();
      }
      ++earliest;
    }
  }
};

class EventLog::Listener {
 public:
  Listener(std::weak_ptr<State> log, std::shared_ptr<Wake> wake)
      : _log(std::move(log)), _wake(std::move(wake)) {}
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  ~Listener() {
    if (const std::shared_ptr<State> log = _log.lock()) {
      const std::lock_guard lock(log->mutex);
      auto wakes = std::make_shared<Wakes>(*log->wakes);
      std::erase(*wakes, _wake);
      log->wakes = std::move(wakes);
    }
    _wake->close();
  }

 private:
  std::weak_ptr<State> _log;
  std::shared_ptr<Wake> _wake;
};

EventLog::EventLog(std::size_t byte_limit, std::uint64_t base)
    : _state(std::make_shared<State>(byte_limit, base)) {}

EventLog::~EventLog() = default;

void EventLog::append(Event event) {
  std::shared_ptr<const Wakes> wakes;
  {
    const std::lock_guard lock(_state->mutex);
    if (_state->ended) {
      return;
    }
    _state->ended = std::holds_alternative<EndEvent>(event);
    if (const auto* sample = std::get_if<SampleEvent>(&event)) {
      _state->samples.push_back(*sample);
    } else {
      const std::size_t bytes = bytes_of(event);
      _state->others.push_back({{_state->latest + 1, std::move(event)}, bytes});
      _state->other_bytes += bytes;
    }
    ++_state->latest;
    _state->trim();
    wakes = _state->wakes;
  }
  for (const std::shared_ptr<Wake>& wake : *wakes) {
    (*wake)();
  }
}

std::uint64_t EventLog::earliest() const {
  const std::lock_guard lock(_state->mutex);
  return _state->earliest;
}

std::uint64_t EventLog::latest() const {
  const std::lock_guard lock(_state->mutex);
  return _state->latest;
}

std::size_t EventLog::bytes() const {
  const std::lock_guard lock(_state->mutex);
  return _state->bytes();
}

bool EventLog::complete() const {
  const std::lock_guard lock(_state->mutex);
  return _state->ended;
}

std::vector<NumberedEvent> EventLog::read(std::uint64_t after, std::size_t count) const {
  std::vector<NumberedEvent> events;
  const std::lock_guard lock(_state->mutex);
  if (after + 1 < _state->earliest || after > _state->latest) {
    throw trimmed(after, _state->earliest, _state->latest);
  }
  const std::size_t size = std::min<std::uint64_t>(count, _state->latest - after);
  events.reserve(size);
  auto other = std::lower_bound(
      _state->others.begin(), _state->others.end(), after + 1,
      [](const Kept& kept, std::uint64_t sequence) { return kept.numbered.sequence < sequence; });
  // Between the earliest event and this one lie as many samples as there are numbers not taken.
  std::size_t sample =
      after + 1 - _state->earliest - static_cast<std::size_t>(other - _state->others.begin());
  for (std::uint64_t sequence = after + 1; events.size() < size; ++sequence) {
    if (other != _state->others.end() && other->numbered.sequence == sequence) {
      events.push_back(other->numbered);
      ++other;
    } else {
      events.push_back({sequence, _state->samples[sample++]});
    }
  }
  return events;
}

std::shared_ptr<EventLog::Listener> EventLog::listen(std::function<void()> wake) {
  auto entry = std::make_shared<Wake>(std::move(wake));
  auto listener = std::make_shared<Listener>(_state, entry);
  const std::lock_guard lock(_state->mutex);
  auto wakes = std::make_shared<Wakes>(*_state->wakes);
  wakes->push_back(std::move(entry));
  _state->wakes = std::move(wakes);
  return listener;
}

}  // namespace anticrack::jobs
