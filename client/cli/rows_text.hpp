// SPDX-License-Identifier: GPL-3.0-or-later
//
// A list of messages in answers, as the parts of the boundary, as a table.
#pragma once

#include <string>

#include "results/entries.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

/// A value of a message as text for a terminal; "-" for a number that is not set.
std::string text_of(const results::Value& value);

/// A row for each message of the list `name` of each load's answer, with all its values.
std::string rows_table(const results::Result& result, const char* name);

}  // namespace anticrack::cli
