// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job as text for users. Pure.
#pragma once

#include <string>
#include <vector>

#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {

/// State, owner, attempt, the answers so far, and the times of its steps.
std::string job_text(const v1::Job& job);

/// A text that says that the results of a job were removed, and what to do.
std::string expired_text(const v1::Job& job);

/// The requests that a job which has ended did not fulfil, line by line; empty if there are none.
std::vector<std::string> shortfalls(const v1::Job& job);

}  // namespace anticrack::cli
