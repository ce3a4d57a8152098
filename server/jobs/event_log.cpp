// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/event_log.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

#include "contact/answer.hpp"
#include "contact/sweep_columns.hpp"
#include "errors/errors.hpp"
#include "fields/walk.hpp"
#include "jobs/sample_queue.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

/// A wake function that can be switched off. One thread at a time calls it: if a call is requested
/// during another call, or by it, the thread of that call makes it.
class Wake {
 public:
  explicit Wake(std::function<void()> call) : _call(std::move(call)) {}

  void operator()() {
    std::unique_lock lock(_mutex);
    _due = true;
    if (_caller != std::thread::id()) return;
    _caller = std::this_thread::get_id();
    while (std::exchange(_due, false) && !_closed) {
      lock.unlock();
      _call();
      lock.lock();
    }
    _caller = {};
    _idle.notify_all();
  }

  /// Waits for a call on another thread, but not for the call in which it is called.
  void close() {
    std::unique_lock lock(_mutex);
    _closed = true;
    if (_caller != std::this_thread::get_id())
      _idle.wait(lock, [&] { return _caller == std::thread::id(); });
  }

 private:
  const std::function<void()> _call;
  std::mutex _mutex;
  std::condition_variable _idle;
  std::thread::id _caller;  ///< none: no call is running
  bool _due = false;
  bool _closed = false;
};

using Wakes = std::vector<std::shared_ptr<Wake>>;

/// Any event but a sample. Such events are rare, so each is kept as it is, with its number.
struct Kept {
  NumberedEvent numbered;
  std::size_t bytes = 0;
};

std::size_t kept_bytes(const Event& event) {
  std::size_t bytes = sizeof(Kept);
  if (const auto* phase = std::get_if<PhaseEvent>(&event))
    bytes += phase->detail.size();
  else if (const auto* ended = std::get_if<CaseEvent>(&event))
    bytes += fields::bytes_of(*ended->record);
  else if (const auto* rows = std::get_if<RowsEvent>(&event))
    bytes += fields::bytes_of(*rows->rows);
  else if (const auto* stage = std::get_if<StageEvent>(&event))
    bytes += fields::bytes_of(*stage->stage);
  else if (const auto* step = std::get_if<GrowthEvent>(&event))
    bytes += fields::bytes_of(*step->row);
  else if (const auto* end = std::get_if<EndEvent>(&event))
    bytes += fields::bytes_of(*end->job);
  return bytes;
}

/// After the event `counted`, sequence numbers are `ahead` of the count of events.
struct Jump {
  std::uint64_t counted = 0;
  std::uint64_t ahead = 0;
};

Batch as_batch(const Event& event) {
  return std::visit(
      []<class Kind>(const Kind& kind) -> Batch {
        if constexpr (std::is_same_v<Kind, SampleEvent> || std::is_same_v<Kind, CaseEvent>)
          return {};  // progress is put into one batch
        else
          return kind;
      },
      event);
}

Error trimmed(std::uint64_t after, std::uint64_t earliest, std::uint64_t latest) {
  const std::string range = fmt::format("the log holds {} to {}", earliest, latest);
  Error error(Reason::sequence_trimmed,
              after > latest ? fmt::format("there is no event {} yet: {}", after, range)
                             : fmt::format("event {} is no longer kept: {}; continue after {}",
                                           after + 1, range, earliest - 1));
  return error.with("earliest_sequence", std::to_string(earliest))
      .with("latest_sequence", std::to_string(latest));
}

}  // namespace

struct EventLog::State {
  State(std::size_t limit, std::uint64_t base, std::shared_ptr<MemoryBudget> budget)
      : byte_limit(limit), share(std::move(budget)), earliest(base + 1), latest(base) {}

  const std::size_t byte_limit;
  MemoryShare share;

  mutable std::mutex mutex;
  SampleQueue samples;
  std::deque<Kept> others;
  std::size_t other_bytes = 0;
  std::deque<Jump> jumps;  ///< ascending; numbers here and below are counts
  std::uint64_t earliest;
  std::uint64_t latest;
  std::uint64_t held_after = UINT64_MAX;  ///< a sequence number
  bool ended = false;
  /// The list is replaced, never changed, so that a writer can go through it without the lock.
  std::shared_ptr<const Wakes> wakes = std::make_shared<const Wakes>();

  std::size_t bytes() const { return samples.bytes() + other_bytes; }

  /// Calls `add(*this)` unless the log is complete, then drops the oldest events and wakes the
  /// listeners.
  template <class Add>
  void append(const Add& add) {
    std::shared_ptr<const Wakes> to_wake;
    {
      const std::lock_guard lock(mutex);
      if (ended) return;
      add(*this);
      trim();
      share.set(bytes());
      to_wake = wakes;
    }
    for (const std::shared_ptr<Wake>& wake : *to_wake) (*wake)();
  }

  /// Keeps the newest event whatever its size; the end event is always the newest.
  void trim() {
    if (share.budget_exceeded())
      trim(std::min(byte_limit, least_bytes), std::min(latest, count_of(held_after)));
    trim(byte_limit, latest);
  }
  void trim(std::size_t limit, std::uint64_t end) {
    while (bytes() > limit && earliest < end) {
      if (!others.empty() && others.front().numbered.sequence == earliest) {
        other_bytes -= others.front().bytes;
        others.pop_front();
        ++earliest;
      } else {
        const std::uint64_t too_many = (bytes() - limit - 1) / SamplePage::bytes_per_sample + 1;
        const std::uint64_t next = others.empty() ? end : others.front().numbered.sequence;
        const std::uint64_t count = std::min({too_many, next - earliest, end - earliest});
        samples.pop_front(count);
        earliest += count;
      }
    }
  }

  /// The sequence number of an event by its count.
  std::uint64_t sequence_of(std::uint64_t counted) const {
    const auto jump = std::find_if(jumps.rbegin(), jumps.rend(),
                                   [&](const Jump& one) { return one.counted < counted; });
    return jump == jumps.rend() ? counted : counted + jump->ahead;
  }
  /// The count of the last event whose sequence number is at most `sequence`.
  std::uint64_t count_of(std::uint64_t sequence) const {
    std::uint64_t last = jumps.empty() ? sequence : latest;
    for (auto jump = jumps.rbegin(); jump != jumps.rend(); last = (jump++)->counted)
      if (sequence > jump->counted + jump->ahead) return std::min(sequence - jump->ahead, last);
    return std::min(sequence, last);
  }

  /// The count for a reader's sequence number. Throws if what comes next is not kept.
  std::uint64_t kept(std::uint64_t after) const {
    const std::uint64_t counted = count_of(after);
    if (counted + 1 < earliest || counted > latest)
      throw trimmed(after, sequence_of(earliest), sequence_of(latest));
    return counted;
  }

  /// The positions after event `after`: first event that is not a sample, and first sample.
  std::pair<std::deque<Kept>::const_iterator, std::uint64_t> next(std::uint64_t after) const {
    const auto other = std::lower_bound(
        others.begin(), others.end(), after + 1,
        [](const Kept& kept, std::uint64_t sequence) { return kept.numbered.sequence < sequence; });
    // From the earliest event to here, every number that no other event has is that of a sample.
    return {other, after + 1 - earliest - static_cast<std::uint64_t>(other - others.begin())};
  }

  NumberedBatch batch(std::uint64_t after, std::size_t count) const {
    auto [other, first_sample] = next(after);
    std::uint64_t end = after + std::min<std::uint64_t>(count, latest - after);
    ProgressEvents progress;
    std::size_t bytes = 0;
    for (; other != others.end() && other->numbered.sequence <= end; ++other) {
      const auto* ended_case = std::get_if<CaseEvent>(&other->numbered.event);
      if (ended_case == nullptr && other->numbered.sequence == after + 1)
        return {after + 1, as_batch(other->numbered.event)};
      if (ended_case == nullptr || bytes >= batch_bytes) {
        end = other->numbered.sequence - 1;
        break;
      }
      progress.ended.push_back(*ended_case);
      bytes += other->bytes;
    }
    progress.samples = samples.runs(first_sample, end - after - progress.ended.size());
    return {end, std::move(progress)};
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

EventLog::EventLog(std::size_t byte_limit, std::uint64_t base, std::shared_ptr<MemoryBudget> budget)
    : _state(std::make_shared<State>(byte_limit, base, std::move(budget))) {}

EventLog::~EventLog() = default;

void EventLog::append(Event event) {
  if (const auto* sample = std::get_if<SampleEvent>(&event)) {
    append({sample, 1});
    return;
  }
  const std::size_t bytes = kept_bytes(event);
  _state->append([&](State& log) {
    log.others.push_back({{log.latest + 1, std::move(event)}, bytes});
    log.ended = std::holds_alternative<EndEvent>(log.others.back().numbered.event);
    log.other_bytes += bytes;
    ++log.latest;
  });
}

void EventLog::append(std::span<const SampleEvent> samples) {
  if (samples.empty()) return;
  _state->append([&](State& log) {
    log.samples.push_back(samples);
    log.latest += samples.size();
  });
}

void EventLog::jump(std::uint64_t sequence) {
  const std::lock_guard lock(_state->mutex);
  State& log = *_state;
  const std::uint64_t latest = log.sequence_of(log.latest);
  if (log.ended || sequence < latest || (sequence == latest && !log.jumps.empty())) return;
  while (!log.jumps.empty() && log.jumps.back().counted == log.latest) log.jumps.pop_back();
  while (log.jumps.size() > 1 && log.jumps[1].counted < log.earliest) log.jumps.pop_front();
  log.jumps.push_back({log.latest, sequence - log.latest});
}

void EventLog::lose(std::uint64_t sequence) {
  const std::lock_guard lock(_state->mutex);
  State& log = *_state;
  const std::uint64_t next = log.sequence_of(log.latest + 1);
  if (log.ended || sequence < next) return;
  log.samples.pop_front(log.samples.size());
  log.others.clear();
  log.other_bytes = 0;
  log.latest += sequence + 1 - next;
  log.earliest = log.latest + 1;
}

void EventLog::hold(std::uint64_t sequence) {
  const std::lock_guard lock(_state->mutex);
  _state->held_after = sequence;
}

std::uint64_t EventLog::earliest() const {
  const std::lock_guard lock(_state->mutex);
  return _state->sequence_of(_state->earliest);
}

std::uint64_t EventLog::latest() const {
  const std::lock_guard lock(_state->mutex);
  return _state->sequence_of(_state->latest);
}

std::size_t EventLog::bytes() const {
  const std::lock_guard lock(_state->mutex);
  return _state->bytes();
}

bool EventLog::complete() const {
  const std::lock_guard lock(_state->mutex);
  return _state->ended;
}

NumberedBatch EventLog::batch(std::uint64_t after, std::size_t count) const {
  const std::lock_guard lock(_state->mutex);
  const std::uint64_t counted = _state->kept(after);
  NumberedBatch batch = _state->batch(counted, count);
  batch.last = batch.last == counted ? after : _state->sequence_of(batch.last);
  return batch;
}

std::vector<NumberedEvent> EventLog::read(std::uint64_t after, std::size_t count) const {
  std::vector<NumberedEvent> events;
  const std::lock_guard lock(_state->mutex);
  after = _state->kept(after);
  const std::size_t size = std::min<std::uint64_t>(count, _state->latest - after);
  events.reserve(size);
  auto [other, sample] = _state->next(after);
  while (events.size() < size) {
    if (other != _state->others.end() && other->numbered.sequence == after + 1)
      events.push_back((other++)->numbered);
    else
      events.push_back({after + 1, _state->samples.runs(sample++, 1).front()[0]});
    events.back().sequence = _state->sequence_of(++after);
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
