// SPDX-License-Identifier: GPL-3.0-or-later
//
// Text for a terminal. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace anticrack::cli {

/// Control characters (escape sequences, line ends) and invalid UTF-8 become '?': what a server
/// sends may not steer the terminal.
std::string sanitise(std::string_view text);

/// Columns of a terminal that valid UTF-8 takes: two for wide characters, none for combining ones.
std::size_t columns_of(std::string_view text) noexcept;

/// Cut to at most `width` columns, the last one "~" where something was cut off.
std::string fit(std::string_view text, std::size_t width);

/// Spaces up to `width`, on the right or on the left.
std::string pad_right(std::string_view text, std::size_t width);
std::string pad_left(std::string_view text, std::size_t width);

/// As printf's %.*g or, for `exponent`, %.*e; "-" for what is not finite.
std::string number(double value, int digits = 6, bool exponent = false);

/// Seconds for people, to three digits but no finer than 0.1 ms: "0.0118", "0.0002", "12.5".
std::string seconds(double value);

/// In the largest of B, kB, MB, GB, TB that leaves at least 1 before the point, to three digits.
std::string bytes(std::uint64_t count);

/// "0.4 s", "42 s", "3 min 5 s", "2 h 10 min": for people.
std::string time_text(double seconds);

/// "2026-11-22 10:25:17" in the zone of this computer, of seconds since 1970.
std::string clock_text(std::int64_t seconds);

/// Rows under each other, two spaces between columns; column 0 and those named in `left` are
/// aligned left. No space at line ends.
std::string table(const std::vector<std::vector<std::string>>& rows,
                  const std::vector<std::size_t>& left = {});

/// Of an enum's number; the first for a number of a later server.
template <std::size_t count>
std::string_view word_of(const std::array<std::string_view, count>& words, int number) noexcept {
  const auto index = static_cast<std::size_t>(number);
  return words[index < count ? index : 0];
}

}  // namespace anticrack::cli
