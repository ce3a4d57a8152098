// SPDX-License-Identifier: GPL-3.0-or-later
//
// The tips of cracks and inclusions as a table.
#pragma once

#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::cli {

/// A row for each tip of each load, and a line for each reason why numbers are missing. Empty where
/// there are no tips; of many, unless `all`, a line that says how to see them.
std::string tips_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all);

}  // namespace anticrack::cli
