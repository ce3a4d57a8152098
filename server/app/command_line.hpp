// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/config.hpp"

namespace CLI {
class App;
}

namespace anticrack::app {

struct CommandLine {
  std::vector<Setting> settings;
  std::string config_file;  ///< empty: none
  bool check_config = false;
  bool is_private = false;  ///< see PrivatePlace
  bool check_store = false;
  bool repair = false;  ///< repairs what check_store finds
  std::string backup;   ///< the folder to make; empty: no backup
  bool copy_store = false;
  bool dry_run = false;  ///< of copy_store
  /// The output of --help or --version, if one of them was given.
  std::optional<std::string> text;
};

/// Sets up the parser, which writes to `result`.
void describe(CLI::App& parser, CommandLine& result, const std::string& version);

/// Throws ConfigError for a bad command line.
CommandLine parse_command_line(int argc, const char* const* argv, const std::string& version);

}  // namespace anticrack::app
