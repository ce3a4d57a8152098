// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where a job's time went, by its timeline; and the names of states as the API has them.
#pragma once

#include <array>
#include <chrono>
#include <string_view>

#include "store/records.hpp"

namespace anticrack::metrics {

enum class Phase { queued, waiting, meshing, factorizing, solving, writing };
inline constexpr std::size_t phase_count = 6;

/// As labels have them, "factorizing".
std::string_view name(Phase phase) noexcept;
std::string_view name(store::JobState state) noexcept;     ///< "SUCCEEDED"
std::string_view name(store::Priority priority) noexcept;  ///< "BULK"

/// The phase a step begins; `waiting` where it waits for a mesh somebody else prepares.
Phase phase_of(const store::Step& step) noexcept;

using PhaseTimes = std::array<std::chrono::duration<double>, phase_count>;

/// Each step lasts until the next, the last until the job ended; a clock set back counts as no
/// time. All attempts together. O(steps).
PhaseTimes phase_times(const store::JobRecord& job);

}  // namespace anticrack::metrics
