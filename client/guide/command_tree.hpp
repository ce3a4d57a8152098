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

/// The value of an option or of a positional.
struct Value {
  enum class Kind { none, text, file, folder, word, key, assignment };  ///< of a case: key=value
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
  std::string path;  ///< words after the program's name; empty: the program
  std::string name;  ///< the last word
  std::string description;
  std::vector<Command> commands;
  std::vector<Option> options;
  std::vector<Option> positionals;
  std::string footer;  ///< what --help ends with
};

/// The program. Options in groups belong to the command.
Command command_tree(const CLI::App& app);

/// The option with this name that may stand behind the command: its own, or one of the program,
/// which every command takes. Null for none.
const Option* option_of(const Command& command, const Command& program, const std::string& name);

/// The command and all its subcommands, parents first.
std::vector<const Command*> with_all_below(const Command& command);

}  // namespace anticrack::guide
