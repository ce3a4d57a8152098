// SPDX-License-Identifier: GPL-3.0-or-later
//
// [job] of a case. For the sources of this folder only.
#pragma once

#include "anticrack/v1/solve.pb.h"
#include "casefile/requests.hpp"

namespace anticrack::casefile {

/// Of the root of a case: the priority and the time limits of its job.
void read_job(const Section& root, v1::Job& job, Spots& spots);

}  // namespace anticrack::casefile
