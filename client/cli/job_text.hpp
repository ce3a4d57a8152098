// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job for people. Pure.
#pragma once

#include <string>
#include <vector>

#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {

/// State, owner, attempt, the answers so far and what happened when.
std::string job_text(const v1::Job& job);

/// That the results of a job were removed, and what to do.
std::string expired_text(const v1::Job& job);

/// What did not go as it was asked for in a job that has ended, line by line; none: nothing.
std::vector<std::string> shortfalls(const v1::Job& job);

}  // namespace anticrack::cli
