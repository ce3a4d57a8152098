// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds programs that this one starts.
#pragma once

#include <filesystem>
#include <string>

namespace anticrack::cli {

/// The path of this executable, with all links resolved.
std::filesystem::path this_program();

/// The program of this name beside `executable`, else the first on `search_path` (like PATH); empty
/// if there is none.
std::filesystem::path find_program(const std::string& name, const std::filesystem::path& executable,
                                   const std::string& search_path);

/// The same, beside this executable or on PATH.
std::filesystem::path find_program(const std::string& name);

}  // namespace anticrack::cli
