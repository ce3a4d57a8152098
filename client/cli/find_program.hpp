// SPDX-License-Identifier: GPL-3.0-or-later
//
// Programs that this one starts.
#pragma once

#include <filesystem>
#include <string>

namespace anticrack::cli {

/// This executable, behind all links.
std::filesystem::path this_program();

/// The program of this name beside `executable`, else the first on `search_path` (as PATH); empty
/// for none.
std::filesystem::path find_program(const std::string& name, const std::filesystem::path& executable,
                                   const std::string& search_path);

/// The same, beside this executable or on PATH.
std::filesystem::path find_program(const std::string& name);

}  // namespace anticrack::cli
