// SPDX-License-Identifier: GPL-3.0-or-later
//
// Times as people write them.
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace anticrack::words {

/// "90", "90s", "1.5 min", "2h", "1d", "250ms": a number, without a unit of seconds, above 0 and at
/// most 366 days. Empty for anything else.
std::optional<std::chrono::milliseconds> parse_duration(std::string_view text);

}  // namespace anticrack::words
