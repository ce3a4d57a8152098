// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.hpp"

#include <algorithm>

namespace anticrack::cli {
namespace {

constexpr double window = 10;  // seconds over which the rate is measured
constexpr double spacing = 0.25;
constexpr std::uint64_t most_counted = std::uint64_t{1} << 28;  // rows

}  // namespace

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

void SweepProgress::raise(const Counts& counts) {
  _counts.done = std::max(_counts.done, counts.done);
  _counts.not_converged = std::max(_counts.not_converged, counts.not_converged);
  _counts.failed = std::max(_counts.failed, counts.failed);
}

void SweepProgress::apply(const v1::SweepRows& rows, double seconds) {
  const std::uint64_t first = rows.first_row(),
                      limit = std::min(total > 0 ? total : most_counted, most_counted);
  if (first >= limit) return;
  if (_samples.empty()) _samples.push_back({seconds, _counts.done});
  const auto count = std::min(static_cast<std::uint64_t>(rows.status_size()), limit - first);
  _ended.resize(std::max<std::size_t>(_ended.size(), first + count));
  for (std::uint64_t i = 0; i < count; ++i) {
    if (_ended[first + i]) continue;  // a new watch repeats rows
    _ended[first + i] = true;
    const int status = rows.status(static_cast<int>(i));
    ++_seen.done;
    _seen.not_converged += status == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED ? 1U : 0U;
    _seen.failed += status == v1::LoadCaseAnswer::STATUS_FAILED ? 1U : 0U;
  }
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
