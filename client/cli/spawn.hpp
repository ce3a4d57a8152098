// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/types.h>

#include <span>
#include <string>
#include <vector>

namespace anticrack::cli {

/// Words as exec takes them: they live as long as `words` do.
std::vector<char*> pointers_to(std::vector<std::string>& words);

/// Starts words[0] with default signals and these words. Its descriptor i is descriptors[i].
/// `flags`: of posix_spawnattr_setflags, besides those of signals. `error`: 0, or the errno with
/// which it did not start.
pid_t spawn(std::vector<std::string> words, std::span<const int> descriptors,
            char* const* environment, short flags, int& error);

}  // namespace anticrack::cli
