// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs that several servers on one store solve together (store::Portion): sweeps, and the final
// positions of growth. The server that runs such a job takes portions as its threads need them, as
// do others that have nothing else to do; what each has solved goes into the store, where the one
// that runs the job, or runs it next, takes it from. A chunk or a position has all it needs in the
// job and the portion, so the numbers are the same to the bit wherever it is solved.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// The work of a thread, until EngineCore::quitting: for each job of which this server solves
/// portions it writes those that are solved, takes others, and, if it runs the job, fetches what
/// other servers have solved. What has been stopped or taken away elsewhere stops within a tick.
void solve_together(EngineCore& core);

/// If a thread has nothing to do, takes up a job that runs elsewhere (LiveJob::helps), for some
/// seconds: then it looks again whose is next. Without the lock; throws errors::Error.
void help(EngineCore& core, const std::vector<std::string>& meshes_held);

/// Solves positions of growth, `portions` of a job that runs here: on base::Threads, and on other
/// servers. `solved(i, body)`, on any of the threads, has the answer to portions[i]. Returns when
/// all are solved; throws the errors::Error of one (cancelled: the job stops), or what `solved`
/// throws.
void solve_portions(EngineCore& core, const JobPtr& job,
                    const std::vector<store::Portion>& portions,
                    const std::function<void(std::size_t i, const std::string& body)>& solved);

// With the lock held:

/// Sets LiveJob::spread, by which the job counts as active until the thread of solve_together() has
/// done with it.
void begin_spread(const JobPtr& job);
/// Its units can be solved.
void make_ready(EngineCore& core, LiveSpread& spread);
/// Counts a chunk or a position as solved here, or stopped.
void note_solved(EngineCore& core, const EndedChunk& chunk);

}  // namespace anticrack::jobs
