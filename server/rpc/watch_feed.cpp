// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/watch_feed.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "errors/placed.hpp"
#include "jobs/job_engine.hpp"
#include "records/job_record.hpp"
#include "rpc/from_domain.hpp"

namespace anticrack::rpc {

WatchFeed::WatchFeed(const Backend& backend, WatchGroups& groups, std::string id,
                     std::uint64_t after)
    : _backend(backend),
      _id(std::move(id)),
      _group(groups.of(_backend.engine.events(_id))),
      _cursor(after),
      _from_earliest(after == 0) {
  errors::at("after_sequence", [&] { read(); });
}

WatchFeed::~WatchFeed() {
  if (_member) _group->leave(*_member);
}

void WatchFeed::start(std::function<void()> wake) { _member = _group->join(std::move(wake)); }

WatchFeed::Next WatchFeed::next(v1::WatchJobResponse& response) {
  if (_ended) return Next::end;
  if (!_snapshot_sent) {
    fill_snapshot(response);
    _snapshot_sent = true;
    return Next::message;
  }
  const jobs::NumberedBatch batch = read();
  if (batch.last == _cursor) {
    const jobs::EventLog& log = _group->log();
    return log.complete() && _cursor == log.latest() ? Next::end : Next::wait;
  }
  std::visit([&](const auto& events) { fill(events, response); }, batch.events);
  _from_earliest = false;
  _cursor = batch.last;
  response.set_sequence(batch.last);
  return Next::message;
}

bool WatchFeed::ending() const noexcept { return _group->log().complete(); }

std::uint64_t WatchFeed::lag() const noexcept {
  const std::uint64_t latest = _group->log().latest();
  const std::uint64_t cursor = _cursor;
  return latest > cursor ? latest - cursor : 0;
}

bool WatchFeed::heartbeat(v1::WatchJobResponse& response) {
  response.set_sequence(_cursor);
  response.mutable_heartbeat()->set_state(_state);
  response.mutable_heartbeat()->set_detail(_detail);
  return true;
}

void WatchFeed::fill_snapshot(v1::WatchJobResponse& response) {
  const records::JobRecord record = _backend.engine.get(_id);
  for (const fem::Load& load : record.spec.loads) _load_names.push_back(load.name);
  _state = static_cast<v1::JobStatus::State>(record.state);
  v1::WatchJobResponse::Snapshot& snapshot = *response.mutable_snapshot();
  *snapshot.mutable_job() = from_domain(record);
  snapshot.set_earliest_sequence(_group->log().earliest());
  snapshot.set_latest_sequence(_group->log().latest());
  response.set_sequence(_cursor);
}

jobs::NumberedBatch WatchFeed::read() {
  const jobs::EventLog& log = _group->log();
  for (;;) {
    if (_from_earliest) _cursor = log.earliest() - 1;
    const std::uint64_t cursor = _cursor;
    const std::uint64_t target = _group->target();
    const std::uint64_t ahead = target > cursor ? target - cursor : 0;
    try {
      return log.batch(cursor, std::min<std::uint64_t>(ahead, max_batch));
    } catch (const errors::Error&) {
      // The log was trimmed between the lines above; a watcher without a sequence misses nothing.
      if (!_from_earliest || log.earliest() - 1 == cursor) throw;
    }
  }
}

void WatchFeed::fill(const jobs::ProgressEvents& progress, v1::WatchJobResponse& response) {
  if (!progress.samples.empty()) append(*response.mutable_samples(), progress.samples);
  for (const jobs::CaseEvent& ended : progress.ended) {
    const auto index = static_cast<std::size_t>(ended.load_case);
    const std::string name = index < _load_names.size() ? _load_names[index] : "";
    v1::LoadCaseEnded& load_case = *response.add_load_cases_ended();
    load_case.set_load_case(ended.load_case);
    *load_case.mutable_answer() = from_domain(*ended.record, name);
  }
}

void WatchFeed::fill(const jobs::PhaseEvent& phase, v1::WatchJobResponse& response) {
  _state = static_cast<v1::JobStatus::State>(phase.state);
  _detail = phase.detail;
  jobs::write(phase, response);
}

void WatchFeed::fill(const jobs::EndEvent& end, v1::WatchJobResponse& response) {
  *response.mutable_ended() = from_domain(*end.job);
  _ended = true;
}

}  // namespace anticrack::rpc
