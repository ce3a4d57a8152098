// SPDX-License-Identifier: GPL-3.0-or-later
//
// The coefficients of a sweep as text: a row per load case, a column per load.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "casefile/error.hpp"

namespace anticrack::casefile {

/// Comma-separated numbers, a line per row. Blank lines and lines that begin with # are passed
/// over. The first line may name the loads instead, in any order; without it the columns are the
/// loads in their order. Quotes around a field are taken off. Returns (rows, loads) row-major, in
/// the order of `loads`, at least one row, all finite. Throws Error with line, column, value and
/// cure; `source` names the text in it. O(length of the text).
std::vector<double> parse_coefficients(std::istream& text, const std::string& source,
                                       const std::vector<std::string>& loads);

/// The same for a file.
std::vector<double> read_coefficients(const std::filesystem::path& file,
                                      const std::vector<std::string>& loads);

}  // namespace anticrack::casefile
