// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/event_rows.hpp"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "jobs/engine_core.hpp"
#include "jobs/event_codec.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

constexpr std::chrono::milliseconds tick{100};
/// Events that are read from a log at once.
constexpr std::size_t events_at_once = 4096;

/// The end of a job that was deleted before its last watcher heard of it.
std::shared_ptr<const records::JobRecord> deleted(const std::string& id) {
  auto record = std::make_shared<records::JobRecord>();
  record->id = id;
  record->state = records::JobState::cancelled;
  record->error = Error(Reason::not_found, "jobs/{} was deleted", id);
  return record;
}

/// The events after `after`, or after the part that is no longer kept; no end event.
std::vector<NumberedEvent> rest_of(const EventLog& log, std::uint64_t after) {
  std::vector<NumberedEvent> events;
  for (;;) {
    try {
      events = log.read(std::max(after, log.earliest() - 1), events_at_once);
      break;
    } catch (const Error&) {  // it was trimmed meanwhile
    }
  }
  if (!events.empty() && std::holds_alternative<EndEvent>(events.back().event)) events.pop_back();
  return events;
}

}  // namespace

void EventRows::publish(const std::vector<JobPtr>& jobs) {
  const std::lock_guard publishing(_publishing);
  for (bool more = true; more;) {
    more = false;
    std::vector<store::EventRow> rows;
    std::vector<std::pair<JobPtr, std::uint64_t>> written;
    for (const JobPtr& job : jobs) {
      job->log->hold(job->published);
      const std::vector<NumberedEvent> events = rest_of(*job->log, job->published);
      if (events.empty()) continue;
      more = more || events.size() == events_at_once;
      for (store::EventRow& row : pack(job->id(), job->created.attempt, events))
        rows.push_back(std::move(row));
      written.emplace_back(job, events.back().sequence);
    }
    if (!rows.empty()) _core.queue->append(rows);
    for (const auto& [job, last] : written) job->published = last;
  }
}

std::shared_ptr<EventLog> EventRows::follow(const records::JobRecord& record) {
  std::shared_ptr<EventLog> log;
  {
    const std::lock_guard lock(_mutex);
    if (const auto found = _followed.find(record.id); found != _followed.end())
      if ((log = found->second.log.lock())) return log;
    log = std::make_shared<EventLog>(_core.options.event_log_bytes, 0, _core.memory);
    log->jump(0);
    _followed[record.id] = {log, 0};
  }
  catch_up({{record.id, log}});
  return log;
}

void EventRows::follow(const std::string& job, const std::shared_ptr<EventLog>& log) {
  const std::uint64_t latest = log->latest();
  log->jump(latest);
  log->hold(UINT64_MAX);
  const std::lock_guard lock(_mutex);
  _followed[job] = {log, latest};
}

void EventRows::work() {
  EngineCore::Lock lock(_core.mutex);
  while (!_core.quitting) {
    std::vector<JobPtr> live;
    for (const auto& [id, job] : _core.jobs) live.push_back(job);
    lock.unlock();
    try {
      publish(live);
      catch_up();
    } catch (const Error&) {
      // The database cannot be reached: events wait in the logs.
    }
    live.clear();
    lock.lock();
    _core.telling.wait_for(lock, tick, [&] { return _core.quitting; });
  }
}

void EventRows::catch_up() {
  Logs logs;
  {
    const std::lock_guard lock(_mutex);
    std::erase_if(_followed, [](const auto& entry) { return entry.second.log.expired(); });
    for (const auto& [job, followed] : _followed)
      if (auto log = followed.log.lock()) logs.emplace(job, std::move(log));
  }
  if (!logs.empty()) catch_up(logs);
}

void EventRows::catch_up(const Logs& logs) {
  const std::lock_guard reading(_reading);
  std::vector<std::string> jobs;
  for (const auto& [job, log] : logs) jobs.push_back(job);
  // Asked before the rows are read: what is written later is not after an end.
  const std::vector<std::string> ended = _core.queue->ended(jobs);
  for (;;) {
    std::vector<store::EventCursor> cursors;
    {
      const std::lock_guard lock(_mutex);
      for (const auto& [job, log] : logs)
        if (const auto found = _followed.find(job); found != _followed.end())
          cursors.push_back({job, found->second.after});
    }
    const std::vector<store::EventRow> rows = _core.queue->events(cursors);
    if (rows.empty()) break;
    for (const store::EventRow& row : rows) unpack(row, *logs.at(row.job));
    const std::lock_guard lock(_mutex);
    for (const store::EventRow& row : rows)
      if (const auto found = _followed.find(row.job); found != _followed.end())
        found->second.after = row.last;
  }
  for (const std::string& job : ended) {
    const std::shared_ptr<EventLog>& log = logs.at(job);
    const std::optional<records::JobRecord> record = _core.store.job(job);
    // The rows of a job that ended long ago are gone: its end has a number above all others.
    if (record && log->latest() == 0) log->jump(sequence_base(record->attempt + 1));
    log->append(
        EndEvent{record ? std::make_shared<const records::JobRecord>(*record) : deleted(job)});
    const std::lock_guard lock(_mutex);
    _followed.erase(job);
  }
}

}  // namespace anticrack::jobs
