// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// The settings of a TOML file, in its order. Throws ConfigError with file and line: the file
/// cannot be read or is not TOML, an unknown key, a value of the wrong type.
std::vector<Setting> read_config_file(const std::string& path);

/// The same for a text; `path` names it in errors.
std::vector<Setting> parse_config(const std::string& text, const std::string& path);

}  // namespace anticrack::app
