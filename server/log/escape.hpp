// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace anticrack::log {

/// Bytes kept of a value; a longer one is cut and ends in "...".
inline constexpr std::size_t longest_value = 4096;

/// `value` for the inside of a JSON string. Escapes quotes, backslashes and characters that are not
/// shown (words/shown.hpp); invalid UTF-8 becomes \ufffd. O(n).
std::string escape(std::string_view value);

/// `value` for a text line: unchanged if that is unambiguous, else escaped and in quotes.
std::string quote_if_needed(std::string_view value);

}  // namespace anticrack::log
