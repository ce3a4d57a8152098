// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <span>
#include <string>
#include <vector>

namespace anticrack::cli {

/// The words as exec takes them; the pointers are valid as long as `words` live.
std::vector<char*> pointers_to(std::vector<std::string>& words);

/// Starts words[0] with these words and default signals. Its descriptor i is descriptors[i].
/// `flags`: for posix_spawnattr_setflags, besides those of signals. `error`: set to 0, or to the
/// errno if it could not start.
pid_t spawn(std::vector<std::string> words, std::span<const int> descriptors,
            char* const* environment, short flags, int& error);

}  // namespace anticrack::cli
