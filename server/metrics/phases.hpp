// SPDX-License-Identifier: GPL-3.0-or-later
//
// The time that a job spent in each phase, and the API's names of states.
#pragma once

#include <array>
#include <chrono>
#include <string_view>

#include "records/job_state.hpp"
#include "records/priority.hpp"

namespace anticrack::records {
struct JobRecord;
struct Step;
}  // namespace anticrack::records

namespace anticrack::metrics {

enum class Phase { queued, waiting, meshing, factorizing, solving, writing };
inline constexpr std::size_t phase_count = 6;

/// The label of a phase, like "factorizing".
std::string_view name(Phase phase) noexcept;
std::string_view name(records::JobState state) noexcept;     ///< "SUCCEEDED"
std::string_view name(records::Priority priority) noexcept;  ///< "BULK"

/// The phase that begins with a step; `waiting` is for a mesh that another job is preparing.
Phase phase_of(const records::Step& step) noexcept;

using PhaseTimes = std::array<std::chrono::duration<double>, phase_count>;

/// Seconds per phase, summed over all attempts. A step lasts until the next one, the last until the
/// job's end; a negative time (the clock was set back) counts as 0. O(steps).
PhaseTimes phase_times(const records::JobRecord& job);

}  // namespace anticrack::metrics
