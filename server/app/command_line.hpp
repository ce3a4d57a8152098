// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

struct CommandLine {
  std::vector<Setting> settings;
  std::string config_file;  ///< empty: none
  bool check_config = false;
  /// What --help or --version print: nothing else is to be done.
  std::optional<std::string> text;
};

/// Throws ConfigError.
CommandLine parse_command_line(int argc, const char* const* argv, const std::string& version);

}  // namespace anticrack::app
