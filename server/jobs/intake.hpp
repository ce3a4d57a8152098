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

/// Makes a job of the store live here, for its first attempt or another. `why`: what is told of
/// another one. `helps`: LiveJob::helps. Without the lock.
JobPtr take_up(EngineCore& core, records::JobRecord record, const std::string& why,
               bool helps = false);

/// Adds the ended jobs of the store to retention; if the store belongs to this server alone, takes
/// up those that have not ended. Call it once, before there are threads.
void recover(EngineCore& core);

}  // namespace anticrack::jobs
