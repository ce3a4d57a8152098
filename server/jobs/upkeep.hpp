// SPDX-License-Identifier: GPL-3.0-or-later
//
// The work of two threads, which they do until EngineCore::quitting.
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// Stops jobs that wait or run longer than they may, and offers jobs again whose start failed.
/// Sleeps until the next of these is due.
void keep_time_limits(EngineCore& core);

/// Deletes results and records as jobs/retention.hpp says, after each end and once a minute, and
/// uploads once a minute. It has a thread of its own, because each removal waits for the disk and
/// would delay ends.
void remove_what_is_too_old(EngineCore& core);

}  // namespace anticrack::jobs
