// SPDX-License-Identifier: GPL-3.0-or-later
//
// For the sources of this folder only.
#pragma once

#include "results/block.hpp"
#include "results/result.hpp"

namespace anticrack::results {

/// Traces along interfaces 0, 1, ... below `at`, which ends with a slash.
std::vector<Trace> traces_of(const Block& block, const std::string& at, std::size_t interfaces);

/// Fills in the columns of result.sweep and makes the loads of its kept rows; result.interfaces are
/// complete. Rows the block has no traces of are kept no longer.
void add_sweep(const Block& block, Result& result);

}  // namespace anticrack::results
