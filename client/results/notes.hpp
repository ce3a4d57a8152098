// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::results {

/// What a reader should know before believing the answers: that one of the units is missing; if
/// the case gives a unit of length, that u exceeds a tenth of the sheet's smaller side, as the
/// equation holds for small slopes. Empty if there is nothing to say.
std::vector<std::string> notes_on(const Result& result);

}  // namespace anticrack::results
