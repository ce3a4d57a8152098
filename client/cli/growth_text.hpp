// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::cli {

/// A row for each position of fronts that grow, and what happens in words; empty without growth. Of
/// many rows, unless `all` are asked for, those where something begins: the first, those before and
/// after jumps, and the last.
std::string growth_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all);

}  // namespace anticrack::cli
