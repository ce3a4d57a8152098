// SPDX-License-Identifier: GPL-3.0-or-later
//
// What two threads do until EngineCore::quitting.
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Stops jobs that wait or run longer than they may, and offers again those whose start failed.
/// Sleeps until the next of these is due.
void keep_time_limits(EngineCore& core);

/// After ends and once a minute results expire and records go as jobs/retention.hpp says; uploads
/// once a minute. Not on the ending thread: each removal waits for the disk, and ends would wait
/// with it.
void remove_what_is_too_old(EngineCore& core);

}  // namespace anticrack::jobs
