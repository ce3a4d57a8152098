// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds and starts other programs.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace anticrack::cli {

/// The path of this executable, with all links resolved.
std::filesystem::path this_program();

/// The program of this name beside `executable`, else the first on `search_path` (like PATH); empty
/// if there is none.
std::filesystem::path find_program(const std::string& name, const std::filesystem::path& executable,
                                   const std::string& search_path);

/// The same, beside this executable or on PATH.
std::filesystem::path find_program(const std::string& name);

/// The words as exec takes them; the pointers are valid as long as `words` live.
std::vector<char*> pointers_to(std::vector<std::string>& words);

/// Starts words[0] with these words and default signals. Its descriptor i is descriptors[i].
/// `flags`: for posix_spawnattr_setflags, besides those of signals. `error`: set to 0, or to the
/// errno if it could not start.
pid_t spawn(std::vector<std::string> words, std::span<const int> descriptors,
            char* const* environment, short flags, int& error);

}  // namespace anticrack::cli
