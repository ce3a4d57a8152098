// SPDX-License-Identifier: GPL-3.0-or-later
//
// Takes in jobs from clients, and those that the last run of the server left.
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

struct TakenIn {
  records::JobRecord record;
  bool is_new = false;  ///< false: the same request made it before
};

/// Does the work of JobEngine::submit. Call it without the lock.
TakenIn take_in(EngineCore& core, const Submission& submission);

/// Queues the unfinished jobs of the store and adds the ended ones to retention. Call it once,
/// before there are threads.
void recover(EngineCore& core);

}  // namespace anticrack::jobs
