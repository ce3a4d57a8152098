// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace anticrack::log {

/// A character of a UTF-8 text.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};
/// The character at the start of `text`, which is not empty. Invalid ones are one byte long.
Character first_character(std::string_view text);

/// Bytes kept of a value; a longer one is cut and ends in "...".
inline constexpr std::size_t longest_value = 4096;

/// `value` for the inside of a JSON string. Escapes quotes, backslashes and control characters,
/// including Unicode's line breaks and marks of writing direction; invalid UTF-8 becomes \ufffd.
/// O(n).
std::string escape(std::string_view value);

/// `value` for a text line: bare if that is unambiguous, else escaped and in quotes.
std::string quote_if_needed(std::string_view value);

}  // namespace anticrack::log
