// SPDX-License-Identifier: GPL-3.0-or-later
//
// The file of --csv.
#pragma once

#include <filesystem>
#include <string>

namespace anticrack::cli {

/// `csv` of the command line; empty stays empty. Throws where it cannot be written or is
/// `result_file`.
std::filesystem::path csv_file(const std::string& csv, const std::filesystem::path& result_file);

}  // namespace anticrack::cli
