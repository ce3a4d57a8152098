// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Takes a job that is to start out of the schedule and counts it as active; false: there is no
/// memory now, and it comes back in a while. With the lock held.
bool may_start(EngineCore& core, const JobPtr& job);
/// Starts a job that may start: RUNNING on the disk first, so that after a crash it is
/// the next attempt, then in its log. A start the store does not take is tried again in a while. A
/// sweep is planned before, so that one which does not fit its mesh fails without having started,
/// and the loads it combines are condensed after. Without the lock.
void start_job(EngineCore& core, std::shared_ptr<const operators::MeshOperator> mesh_operator,
               const JobPtr& job);

/// The longest a job may wait, or run: its own limit, or the server's.
std::chrono::milliseconds queue_limit(const LiveJob& job, const EngineOptions& options);
std::chrono::milliseconds run_limit(const LiveJob& job, const EngineOptions& options);

}  // namespace anticrack::jobs
