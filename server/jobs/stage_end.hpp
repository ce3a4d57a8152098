// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// All load cases of the job's stage have ended: decides whether it was the last, else makes the
/// mesh of the next, stores and tells how far the job is, and puts it back into the queue. Counted
/// in LiveJob::active meanwhile. Without the lock.
void end_stage(EngineCore& core, const JobPtr& job);

/// The mesh of a job's stage turned out to be too large for the memory: the job ends with the
/// answers of the stage before, or solves that again where a restart has lost them. False: there is
/// none, or it must stop anyway. With the lock held.
bool fall_back_a_stage(EngineCore& core, const JobPtr& job, const errors::Error& error);

}  // namespace anticrack::jobs
