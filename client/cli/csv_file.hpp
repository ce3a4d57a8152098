// SPDX-License-Identifier: GPL-3.0-or-later
//
// The file for --csv.
#pragma once

#include <filesystem>
#include <string>

namespace anticrack::cli {

/// The path for `csv` of the command line; empty if that is empty. Throws if the file cannot be
/// written or is `result_file`.
std::filesystem::path csv_file(const std::string& csv, const std::filesystem::path& result_file);

}  // namespace anticrack::cli
