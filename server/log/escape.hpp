// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace anticrack::log {

/// Bytes of a value that are kept; of a longer one the rest is cut off and "..." says so.
inline constexpr std::size_t longest_value = 4096;

/// `value` as the inside of a JSON string, in one line: quotes, backslashes and control characters
/// escaped, among them those of Unicode that break lines or turn the writing direction; what is no
/// UTF-8 becomes \ufffd. O(n).
std::string escape(std::string_view value);

/// As a value of a text line: bare where nobody could take it for anything else, else in quotes and
/// escaped.
std::string quote_if_needed(std::string_view value);

}  // namespace anticrack::log
