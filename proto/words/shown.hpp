// SPDX-License-Identifier: GPL-3.0-or-later
//
// Text of others, made safe for a terminal, a page or a line of a log: it must neither control it
// nor look like another text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace anticrack::words {

/// A character of a UTF-8 text.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};
/// The character at the start of `text`, which is not empty. Invalid ones are one byte long.
Character first_character(std::string_view text);

/// What does not show itself: control characters, line separators, marks of the direction of
/// writing and whatever else Unicode calls format or ignorable, as a zero-width space.
bool is_hidden(std::uint32_t code);

/// Hidden characters but those in `keep`, and each byte that is not UTF-8, become '?'. O(n).
std::string shown(std::string_view text, std::string_view keep = {});

/// The inside of a JSON string, or a whole JSON text, with the same meaning: hidden characters but
/// those in `keep` become \uXXXX. O(n).
std::string escaped_in_json(std::string_view json, std::string_view keep = "\n");

/// `text` as valid UTF-8 of at most `max_bytes` (>= 3). What is hidden (words/shown.hpp) and
/// invalid bytes become '?'; longer text is cut between characters and ends in "...". O(n).
std::string printable(std::string_view text, std::size_t max_bytes);

/// Whether `text` is valid UTF-8. O(n).
bool is_utf8(std::string_view text);

}  // namespace anticrack::words
