// SPDX-License-Identifier: GPL-3.0-or-later
//
// The lists of messages in answers as tables. Pure.
#pragma once

#include <string>
#include <vector>

#include "results/entries.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// A value of a message as text; "-" for a number that is not set.
std::string text_of(const results::Value& value);

/// A row for each message of the list `name` of each load's answer, with all its values.
std::string list_table(const results::Result& result, const char* name);

/// A row for each tip of each load, and a line for each reason why numbers are missing. Empty where
/// there are no tips; of many, unless `all`, a line that says how to see them.
std::string tips_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all);

/// A row for each position of fronts that grow, and what happens in words; empty without growth. Of
/// many rows, unless `all` are asked for, those where something begins: the first, those before and
/// after jumps, and the last.
std::string growth_table(const std::vector<results::Load>& loads, const v1::Units& units, bool all);

/// A row for each stage of the load: its triangles, the energy and its bounds, the error of u in
/// the energy norm and, if it is known, that of A. Empty if there are no stages.
std::string stages_table(const results::Load& load);

}  // namespace anticrack::cli
