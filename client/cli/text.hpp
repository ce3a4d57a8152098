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

/// The text after words::shown(): text from a server must not control the terminal or add a line.
std::string sanitise(std::string_view text);

/// The terminal columns of valid UTF-8: two for wide characters, none for combining ones.
std::size_t columns_of(std::string_view text) noexcept;

/// The text in at most `width` columns; the last one is "~" if it was cut.
std::string fit(std::string_view text, std::size_t width);

/// Adds spaces up to `width`, on the right or on the left.
std::string pad_right(std::string_view text, std::size_t width);
std::string pad_left(std::string_view text, std::size_t width);

/// A number as by printf's %.*g or, with `exponent`, %.*e; "-" if it is not finite.
std::string number(double value, int digits = 6, bool exponent = false);

/// The shortest text that gives the number back; empty if it is not finite.
std::string exact(double value);

/// A relative error as text: "0.8 %", "12 %", "110 %".
std::string per_cent(double value);

/// A contact length with three digits: it has no bounds and is right to about an edge of the mesh.
std::string contact_text(double length);

/// A field of comma-separated text, in quotes if it needs them.
std::string csv_field(std::string_view text);

/// Seconds with three digits, but no finer than 0.1 ms: "0.0118", "0.0002", "12.5".
std::string seconds(double value);

/// A size with three digits and the largest unit of B, kB, MB, GB, TB in which it is at least 1.
std::string bytes(std::uint64_t count);

/// A time as text: "0.4 s", "42 s", "3 min 5 s", "2 h 10 min".
std::string time_text(double seconds);

/// Seconds since 1970 as local time, "2026-11-22 10:25:17".
std::string clock_text(std::int64_t seconds);

/// A table with columns two spaces apart; column 0 and those in `left` are aligned left. There are
/// no trailing spaces. Cells are sanitised.
std::string table(std::vector<std::vector<std::string>> rows,
                  const std::vector<std::size_t>& left = {});

/// A table of a head and the first rows, with a line that counts the others; --json has them all.
std::string short_table(std::vector<std::vector<std::string>> rows,
                        const std::vector<std::size_t>& left = {});

/// "1 row", "2 rows".
std::string counted(std::size_t count, const std::string& one);

/// Removes a column of a table if it has nothing but a title in the first row.
void drop_if_empty(std::vector<std::vector<std::string>>& rows, std::size_t column);

/// The word for the number of an enum; the first word for an unknown number.
template <std::size_t count>
std::string_view word_of(const std::array<std::string_view, count>& words, int number) noexcept {
  const auto index = static_cast<std::size_t>(number);
  return words[index < count ? index : 0];
}

}  // namespace anticrack::cli
