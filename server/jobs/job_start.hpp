// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Takes a job that is to start out of the schedule and counts it as active. Returns false if there
/// is no memory now; the job then comes back in a while. With the lock held.
bool may_start(EngineCore& core, const JobPtr& job);
/// Starts a job that may start: writes RUNNING to the disk first, so that a run after a crash
/// counts as the next attempt, then to its log. If the store does not take it, the start is tried
/// again in a while. A sweep is planned before that, so that one that does not fit its mesh fails
/// without having started; the loads it combines are condensed after it. Without the lock.
void start_job(EngineCore& core, std::shared_ptr<const operators::MeshOperator> mesh_operator,
               const JobPtr& job);

/// How long a job may wait, or run: its own limit, or else the server's.
std::chrono::milliseconds queue_limit(const LiveJob& job, const EngineOptions& options);
std::chrono::milliseconds run_limit(const LiveJob& job, const EngineOptions& options);

}  // namespace anticrack::jobs
