// SPDX-License-Identifier: GPL-3.0-or-later
//
// [solver] of a case. For the sources of this folder only.
#pragma once

#include "anticrack/v1/solve.pb.h"
#include "casefile/requests.hpp"

namespace anticrack::casefile {

/// Of the root of a case. A key of the method that is not chosen is an Error.
v1::Solver read_solver(const Section& root, Spots& spots);

}  // namespace anticrack::casefile
