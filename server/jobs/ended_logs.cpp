// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/ended_logs.hpp"

#include <algorithm>
#include <utility>

#include "records/job_record.hpp"

namespace anticrack::jobs {

std::shared_ptr<EventLog> end_alone(const records::JobRecord& record) {
  constexpr std::size_t any_size = 1;  // the end event is kept whatever the limit
  auto log = std::make_shared<EventLog>(any_size, sequence_base(record.attempt + 1));
  log->append(EndEvent{std::make_shared<const records::JobRecord>(record)});
  return log;
}

void EndedLogs::add(const std::string& job, std::shared_ptr<EventLog> log, std::uint64_t bytes) {
  _logs[job] = {std::move(log), bytes};
  _order.push_back(job);
  _bytes += bytes;
  while (_bytes > _budget->limit() / 2) remove(std::string(_order.front()));
  make_room(0);
}

void EndedLogs::make_room(std::uint64_t bytes) {
  while (_budget->exceeded_by(bytes) && !_order.empty()) remove(std::string(_order.front()));
}

void EndedLogs::remove(const std::string& job) {
  const auto found = _logs.find(job);
  if (found != _logs.end()) {
    _bytes -= found->second.bytes;
    _logs.erase(found);
    _order.erase(std::find(_order.begin(), _order.end(), job));
  }
}

std::shared_ptr<EventLog> EndedLogs::find(const std::string& job) const {
  const auto found = _logs.find(job);
  return found == _logs.end() ? nullptr : found->second.log;
}

}  // namespace anticrack::jobs
