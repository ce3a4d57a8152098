// SPDX-License-Identifier: GPL-3.0-or-later
//
// The coefficients of a sweep as text: a row per load case, a column per load.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "cli/case_error.hpp"

namespace anticrack::cli {

/// Comma-separated numbers, a line per row; separated by semicolons where the first line has one,
/// and then decimal commas are read, too. Blank lines and lines that begin with # are skipped.
/// The first line may name the loads, in any order; without it the columns follow `loads`. Quotes
/// around a field are removed. Returns (rows, loads) row-major, in the order of `loads`: at least
/// one row, all values finite. Throws CaseError with `source`, line, column, value and cure.
/// O(length).
std::vector<double> parse_coefficients(std::istream& text, const std::string& source,
                                       const std::vector<std::string>& loads);

/// The same for a file.
std::vector<double> read_coefficients(const std::filesystem::path& file,
                                      const std::vector<std::string>& loads);

}  // namespace anticrack::cli
