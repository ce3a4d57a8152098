// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps that several servers on one store solve together (store::Portion). The server that runs
// such a job takes portions as its threads need them, as do others that have nothing else to do;
// what each has solved goes into the store, where the one that runs the job, or runs it next, takes
// it from. The chunks are those of a server alone, so the numbers are the same to the bit.
#pragma once

#include <string>
#include <vector>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// The work of a thread, until EngineCore::quitting: for each sweep of which this server solves
/// portions it writes those that are solved, takes others, and, if it runs the job, fetches what
/// other servers have solved. What has been stopped or taken away elsewhere stops within a tick.
void solve_together(EngineCore& core);

/// If a thread has nothing to do, takes up a sweep that runs elsewhere (LiveJob::helps), for some
/// seconds: then it looks again whose is next. Without the lock; throws errors::Error.
void help(EngineCore& core, const std::vector<std::string>& meshes_held);

/// Counts a chunk of a spread sweep as solved here, or stopped. With the lock held.
void note_solved(EngineCore& core, const EndedChunk& chunk);

}  // namespace anticrack::jobs
