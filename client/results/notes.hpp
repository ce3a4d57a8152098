// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::results {

/// What a reader of the answers should know before believing them: units of which one is missing;
/// where the case gives a unit of length, u of more than a tenth of the sheet's smaller side, as
/// the equation is that of small slopes. Empty: nothing.
std::vector<std::string> notes_on(const Result& result);

}  // namespace anticrack::results
