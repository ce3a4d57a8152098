// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/phases.hpp"

#include <algorithm>

namespace anticrack::metrics {

using store::JobState;

std::string_view name(Phase phase) noexcept {
  constexpr std::array<std::string_view, phase_count> names{"queued",      "waiting", "meshing",
                                                            "factorizing", "solving", "writing"};
  return names[static_cast<std::size_t>(phase)];
}

std::string_view name(JobState state) noexcept {
  switch (state) {
    case JobState::queued:
      return "QUEUED";
    case JobState::waiting_for_mesh:
      return "WAITING_FOR_MESH";
    case JobState::running:
      return "RUNNING";
    case JobState::succeeded:
      return "SUCCEEDED";
    case JobState::failed:
      return "FAILED";
    case JobState::cancelled:
      return "CANCELLED";
    case JobState::expired:
      return "EXPIRED";
  }
  return "UNKNOWN";
}

std::string_view name(store::Priority priority) noexcept {
  switch (priority) {
    case store::Priority::interactive:
      return "INTERACTIVE";
    case store::Priority::normal:
      return "NORMAL";
    case store::Priority::bulk:
      return "BULK";
  }
  return "UNKNOWN";
}

Phase phase_of(const store::Step& step) noexcept {
  if (step.state == JobState::waiting_for_mesh) {
    if (step.detail.starts_with("mesh")) return Phase::meshing;
    if (step.detail.starts_with("factor")) return Phase::factorizing;
    return Phase::waiting;
  }
  if (step.state == JobState::running) {
    return step.detail.starts_with("writ") ? Phase::writing : Phase::solving;
  }
  return Phase::queued;
}

PhaseTimes phase_times(const store::JobRecord& job) {
  PhaseTimes times{};
  for (std::size_t i = 0; i < job.timeline.size(); ++i) {
    const store::Step& step = job.timeline[i];
    if (store::ended(step.state)) continue;
    const bool last = i + 1 == job.timeline.size();
    const auto until = last ? job.ended.value_or(step.time) : job.timeline[i + 1].time;
    const std::chrono::duration<double> time = until - step.time;
    times[static_cast<std::size_t>(phase_of(step))] +=
        std::max(time, std::chrono::duration<double>::zero());
  }
  return times;
}

}  // namespace anticrack::metrics
