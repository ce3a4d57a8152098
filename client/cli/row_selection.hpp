// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows of a sweep as a person names them. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace anticrack::cli {

/// "all", "none", or numbers from 0 and inclusive ranges, "0,10,20-30", in any order, possibly
/// overlapping. Returns each row once, ascending. Throws casefile::Error for anything else, for a
/// row outside 0..rows, and for more than `most` rows. O(rows returned).
std::vector<std::uint32_t> select_rows(const std::string& text, std::uint64_t rows,
                                       std::uint64_t most);

}  // namespace anticrack::cli
