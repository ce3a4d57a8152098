// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands and options of the parser, for shells and manual pages.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace anticrack::guide {

/// The value of an option or of a positional argument.
struct Value {
  enum class Kind {
    none,
    text,
    file,
    folder,
    word,
    key,
    assignment
  };  ///< key, key=value of a
      ///< case
  Kind kind = Kind::none;
  std::vector<std::string> words;  ///< the choices of Kind::word
};

struct Option {
  std::vector<std::string> names;  ///< with their dashes; for a positional argument its name
  std::string type;                ///< as in --help, e.g. FILE; empty for a flag
  std::string description;
  Value value;
};

struct Command {
  std::string path;  ///< words after the program's name; empty for the program itself
  std::string name;  ///< last word of the path
  std::string description;
  std::vector<Command> commands;
  std::vector<Option> options;
  std::vector<Option> positionals;
  std::string footer;  ///< the end of --help
};

/// The program with all its commands. Options in groups belong to their command.
Command command_tree(const CLI::App& app);

/// The option with this name that may follow the command: one of its own, or one of the program,
/// which every command takes. Null if there is none.
const Option* option_of(const Command& command, const Command& program, const std::string& name);

/// The command and all its subcommands, parents first.
std::vector<const Command*> with_all_below(const Command& command);

}  // namespace anticrack::guide
