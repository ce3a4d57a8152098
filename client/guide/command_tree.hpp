// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a shell has to know of the parser.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace anticrack::guide {

/// What follows an option, or stands where a positional does.
struct Value {
  enum class Kind { none, text, file, folder, word };
  Kind kind = Kind::none;
  std::vector<std::string> words;  ///< of Kind::word
};

struct Option {
  std::vector<std::string> names;  ///< with their dashes; of a positional its name
  std::string type;                ///< as --help writes it, e.g. FILE; empty for a flag
  std::string description;
  Value value;
};

struct Command {
  std::string path;  ///< words from below the program's name, with spaces between; empty: itself
  std::string name;  ///< the last of them
  std::string description;
  std::vector<Command> commands;
  std::vector<Option> options;
  std::vector<Option> positionals;
  std::string footer;  ///< what --help ends with
};

/// The program itself. Options in groups are the command's.
Command command_tree(const CLI::App& app);

/// The command and all below it, the outer first.
std::vector<const Command*> with_all_below(const Command& command);

}  // namespace anticrack::guide
