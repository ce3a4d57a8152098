// SPDX-License-Identifier: GPL-3.0-or-later
//
// How jobs come in: from clients, and from the last start of the server.
#pragma once

#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

struct TakenIn {
  records::JobRecord record;
  bool is_new = false;  ///< else made by the same request before
};

/// JobEngine::submit, without the lock.
TakenIn take_in(EngineCore& core, const Submission& submission);

/// Queues the store's unfinished jobs and gives retention its ended ones. Call it once,
/// before there are threads.
void recover(EngineCore& core);

}  // namespace anticrack::jobs
