// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Call it when all load cases of the job's stage have ended. Decides whether the stage was the
/// last; if not, makes the mesh of the next one, stores and tells the progress, and puts the job
/// back into the queue. Counts in LiveJob::active meanwhile. Without the lock.
void end_stage(EngineCore& core, const JobPtr& job);

/// Call it when the mesh of a job's stage turned out to be too large for the memory: the job ends
/// with the answers of the stage before, or solves that stage again if a restart has lost them.
/// Returns false if there is no stage before, or the job must stop anyway. With the lock held.
bool fall_back_a_stage(EngineCore& core, const JobPtr& job, const errors::Error& error);

}  // namespace anticrack::jobs
