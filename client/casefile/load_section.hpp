// SPDX-License-Identifier: GPL-3.0-or-later
//
// [[load]] of a case. For the sources of this folder only.
#pragma once

#include "casefile/case.hpp"
#include "casefile/requests.hpp"

namespace anticrack::casefile {

/// Of the root of a case: fills the job's load cases, force_files and spots.
void read_loads(const Section& root, Case& result);

}  // namespace anticrack::casefile
