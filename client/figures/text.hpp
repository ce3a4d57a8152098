// SPDX-License-Identifier: GPL-3.0-or-later
//
// Text for gnuplot scripts and names of files. gnuplot runs shell commands from backquotes, lines
// that begin with "!" and output names that begin with "|": foreign text must pass through
// `quoted`, and paths never enter a script.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace anticrack::figures {

/// Bytes of the first character of a text that is not empty; 0 if it is not UTF-8 or is hidden
/// (words/shown.hpp).
std::size_t character(std::string_view text);

/// `text` as a single-quoted string of gnuplot on one line: quotes doubled; backquotes, control
/// characters and invalid UTF-8 replaced; cut to `limit` characters with an ellipsis. For
/// `noenhanced` text.
std::string quoted(std::string_view text, std::size_t limit = 110);

/// Characters of a UTF-8 text.
std::size_t length(std::string_view text);

/// At most `limit` characters, the last an ellipsis if cut.
std::string shortened(std::string_view text, std::size_t limit);

/// At most `most` lines of at most `width` characters, broken at blanks; the last line holds the
/// rest. No lines for an empty text.
std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::size_t most);

/// "10⁻¹²".
std::string power_of_ten(int exponent);

/// Significant digits, independent of the locale; "NaN" for what is not finite.
std::string number(double value, int digits = 9);
/// A few significant digits, for people: "−1.5×10⁻¹²".
std::string readable(double value, int digits = 4);

/// An interval, for people: "0.10383 ± 0.00020".
std::string bounded(double lower, double upper);

/// A file name stem for each name: [A-Za-z0-9][A-Za-z0-9_.-]*. No two stems, with any of `suffixes`
/// or none, are equal, ignoring case.
std::vector<std::string> file_stems(const std::vector<std::string>& names,
                                    const std::vector<std::string>& suffixes);

}  // namespace anticrack::figures
