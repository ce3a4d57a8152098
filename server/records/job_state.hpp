// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::records {

enum class JobState {
  queued = 1,
  waiting_for_mesh,
  running,
  succeeded,
  failed,
  cancelled,
  not_converged,  ///< ran to its end, but some cases did not converge or failed
};

/// Whether a job in this state no longer changes, except that its result may be removed.
constexpr bool ended(JobState state) noexcept { return state >= JobState::succeeded; }

}  // namespace anticrack::records
