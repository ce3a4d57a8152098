// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::app {

/// What other users of the machine may do with a file that controls access.
enum class OthersMay { nothing, read };

/// The content of a file of at most 1 MiB. `key`: the setting that names it, with which messages
/// begin. Throws ConfigError: the file cannot be read, is too large, or others may do more than
/// `others_may`. Permissions of the group are not checked, as services get credentials through it.
std::string read_guarded_file(const std::string& key, const std::string& path,
                              OthersMay others_may);

}  // namespace anticrack::app
