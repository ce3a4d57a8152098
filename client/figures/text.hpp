// SPDX-License-Identifier: GPL-3.0-or-later
//
// What may enter a gnuplot script, and what a figure's file may be called. gnuplot runs shell
// commands from backquotes, from lines that begin with "!" and from output names that begin with
// "|", so text from outside goes in only through `quoted`, and paths do not go in at all.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace anticrack::figures {

/// Bytes of the character that a text begins with; 0 where that is not UTF-8, not printable, or
/// would disguise the text: a control character, a mark of the direction of writing. `text` is not
/// empty.
std::size_t character(std::string_view text);

/// `text` as a single-quoted string of gnuplot on one line: quotes doubled, backquotes, control
/// characters and bytes that are not UTF-8 replaced. Longer than `limit` characters: cut, with an
/// ellipsis. For places marked `noenhanced`.
std::string quoted(std::string_view text, std::size_t limit = 110);

/// Characters of a UTF-8 text.
std::size_t length(std::string_view text);

/// At most `limit` characters, the last of them an ellipsis where it is cut.
std::string shortened(std::string_view text, std::size_t limit);

/// Lines of at most `width` characters where there are blanks to break at; the last of at most
/// `most` lines holds all that is left. No lines of an empty text.
std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::size_t most);

/// "10⁻¹²".
std::string power_of_ten(int exponent);

/// Significant digits, independent of the locale; "NaN" for what is not finite.
std::string number(double value, int digits = 9);
/// A few significant digits, for people: "−1.5×10⁻¹²".
std::string readable(double value, int digits = 4);

/// One file name stem a load: [A-Za-z0-9][A-Za-z0-9_.-]*, such that no two stems with any of
/// `suffixes` (or none) coincide, upper and lower case not told apart.
std::vector<std::string> file_stems(const std::vector<std::string>& names,
                                    const std::vector<std::string>& suffixes);

}  // namespace anticrack::figures
