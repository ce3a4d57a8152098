// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::app {

/// What somebody else on this machine may do with a file that decides who is let in.
enum class OthersMay { nothing, read };

/// The content of a file of at most 1 MiB. Throws ConfigError, which begins with `key`, the setting
/// that named it: it cannot be read, is too large, or others may do more with it than `others_may`
/// (its group is the administrator's business: that is how credentials are handed to services).
std::string read_guarded_file(const std::string& key, const std::string& path,
                              OthersMay others_may);

}  // namespace anticrack::app
