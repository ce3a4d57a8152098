// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows of a sweep as a person names them. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace anticrack::cli {

/// "all", "none", or numbers from 0 and ranges with both ends, "0,10,20-30", in any order and
/// possibly overlapping; ascending and each once in what is returned. Throws casefile::Error for
/// anything else, for a row that a sweep of `rows` rows does not have, and for more than `most`.
/// O(what is returned), however large the numbers.
std::vector<std::uint32_t> select_rows(const std::string& text, std::uint64_t rows,
                                       std::uint64_t most);

}  // namespace anticrack::cli
