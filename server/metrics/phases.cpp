// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/phases.hpp"

#include <algorithm>

#include "records/job_record.hpp"

namespace anticrack::metrics {

using records::JobState;

std::string_view name(Phase phase) noexcept {
  constexpr std::array<std::string_view, phase_count> names{"queued",      "waiting", "meshing",
                                                            "factorizing", "solving", "writing"};
  return names[static_cast<std::size_t>(phase)];
}

std::string_view name(JobState state) noexcept {
  constexpr std::array<std::string_view, 9> names{"UNKNOWN",   "QUEUED",    "WAITING_FOR_MESH",
                                                  "RUNNING",   "SUCCEEDED", "FAILED",
                                                  "CANCELLED", "UNKNOWN",   "NOT_CONVERGED"};
  return names[static_cast<std::size_t>(state)];
}

std::string_view name(records::Priority priority) noexcept {
  constexpr std::array<std::string_view, 4> names{"UNKNOWN", "INTERACTIVE", "NORMAL", "BULK"};
  return names[static_cast<std::size_t>(priority)];
}

Phase phase_of(const records::Step& step) noexcept {
  if (step.state == JobState::waiting_for_mesh) {
    if (step.detail.starts_with("mesh")) return Phase::meshing;
    if (step.detail.starts_with("factor")) return Phase::factorizing;
    return Phase::waiting;
  }
  if (step.state == JobState::running)
    return step.detail.starts_with("writ") ? Phase::writing : Phase::solving;
  return Phase::queued;
}

PhaseTimes phase_times(const records::JobRecord& job) {
  PhaseTimes times{};
  for (std::size_t i = 0; i < job.timeline.size(); ++i) {
    const records::Step& step = job.timeline[i];
    if (records::ended(step.state)) continue;
    const bool last = i + 1 == job.timeline.size();
    const auto until = last ? job.ended.value_or(step.time) : job.timeline[i + 1].time;
    const std::chrono::duration<double> time = until - step.time;
    times[static_cast<std::size_t>(phase_of(step))] +=
        std::max(time, std::chrono::duration<double>::zero());
  }
  return times;
}

}  // namespace anticrack::metrics
