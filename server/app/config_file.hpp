// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// The settings of a TOML file, in its order. Throws ConfigError: the file cannot be read, is no
/// TOML, or holds a key or a type of value that is not known; says file and line.
std::vector<Setting> read_config_file(const std::string& path);

/// The same for a text; `path` names it in errors.
std::vector<Setting> parse_config(const std::string& text, const std::string& path);

}  // namespace anticrack::app
