// SPDX-License-Identifier: GPL-3.0-or-later
//
// Text from outside, made safe for errors and logs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace anticrack::api {

/// `text` as valid UTF-8 of at most `max_bytes` (>= 3). What is hidden (words/shown.hpp) and
/// invalid bytes become '?'; longer text is cut between characters and ends in "...". O(n).
std::string printable(std::string_view text, std::size_t max_bytes);

/// Whether `text` is valid UTF-8. O(n).
bool is_utf8(std::string_view text);

}  // namespace anticrack::api
