// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_progress.hpp"

#include <algorithm>

namespace anticrack::cli {
namespace {

constexpr double window = 10;  // seconds over which the rate is measured
constexpr double spacing = 0.25;

}  // namespace

std::vector<RowSet::Interval> RowSet::add(std::uint64_t begin, std::uint64_t end) {
  std::vector<Interval> added;
  if (begin >= end) return added;
  std::uint64_t from = begin, joined_begin = begin, joined_end = end;
  auto it = _ends.upper_bound(begin);
  if (it != _ends.begin() && std::prev(it)->second >= begin) --it;
  while (it != _ends.end() && it->first <= end) {
    if (it->first > from) added.emplace_back(from, it->first);
    from = std::max(from, it->second);
    joined_begin = std::min(joined_begin, it->first);
    joined_end = std::max(joined_end, it->second);
    it = _ends.erase(it);
  }
  if (from < end) added.emplace_back(from, end);
  _ends.emplace(joined_begin, joined_end);
  return added;
}

double SweepProgress::rate() const noexcept {
  if (_samples.empty() || !(_now > _samples.front().seconds))
    return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(_counts.done - _samples.front().done) /
         (_now - _samples.front().seconds);
}

double SweepProgress::seconds_left() const noexcept {
  const double rows_a_second = rate();
  if (total < _counts.done || total == 0 || !(rows_a_second > 0))
    return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(total - _counts.done) / rows_a_second;
}

void SweepProgress::count(const v1::SweepRows& rows, const RowSet::Interval& interval) {
  for (std::uint64_t row = interval.first; row < interval.second; ++row) {
    const int status = rows.status(static_cast<int>(row - rows.first_row()));
    _seen.not_converged += status == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED ? 1U : 0U;
    _seen.failed += status == v1::LoadCaseAnswer::STATUS_FAILED ? 1U : 0U;
  }
  _seen.done += interval.second - interval.first;
}

void SweepProgress::raise(const Counts& counts) {
  _counts.done = std::max(_counts.done, counts.done);
  _counts.not_converged = std::max(_counts.not_converged, counts.not_converged);
  _counts.failed = std::max(_counts.failed, counts.failed);
}

void SweepProgress::apply(const v1::SweepRows& rows, double seconds) {
  const auto count_of_rows = static_cast<std::uint64_t>(rows.status_size());
  const std::uint64_t limit = total > 0 ? total : std::numeric_limits<std::uint64_t>::max();
  if (rows.first_row() >= limit) return;
  if (_samples.empty()) _samples.push_back({seconds, _counts.done});
  const std::uint64_t end = rows.first_row() + std::min(count_of_rows, limit - rows.first_row());
  for (const RowSet::Interval& interval : _rows.add(rows.first_row(), end)) count(rows, interval);
  raise(_seen);
  _now = seconds;
  if (seconds - _samples.back().seconds >= spacing) _samples.push_back({seconds, _counts.done});
  while (_samples.size() > 2 && seconds - _samples.front().seconds > window) _samples.pop_front();
}

void SweepProgress::apply(const v1::SweepAnswer& answer) {
  if (answer.rows() > 0) total = answer.rows();
  raise({answer.converged() + answer.not_converged() + answer.failed(), answer.not_converged(),
         answer.failed()});
}

void SweepProgress::restart() {
  const std::uint64_t rows = total;
  *this = SweepProgress();
  total = rows;
}

}  // namespace anticrack::cli
