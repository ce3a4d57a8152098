// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands and options of the parser, for shells and manual pages; the completion of shells and
// the manual, made from the texts of --help. The scripts of the shells know nothing of the
// commands: they ask `anticrack --complete WORD...` what may replace the last word.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace anticrack::guide {

/// The value of an option or of a positional argument.
struct Value {
  /// The last two are a key of a case, and key=value.
  enum class Kind { none, text, file, folder, word, key, assignment };
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

enum class Shell { bash, zsh, fish };

/// The script, to be sourced or installed among the shell's completions.
std::string_view completion_script(Shell shell);

/// Completions for the words after the program's name: lines "WORD<tab>DESCRIPTION" of commands,
/// options or values that begin like the last word; ":files" or ":folders" if a path is wanted. A
/// word that names a subcommand of the current command leads to it; other words are skipped.
/// `keys`: returns the keys of cases, called if one is wanted.
std::string completions(const CLI::App& app, const std::vector<std::string>& words,
                        const std::function<std::vector<std::string>()>& keys);

struct Page {
  std::string file;  ///< "anticrack-mesh-create.1"
  std::string text;  ///< in the man macros of roff
};

/// The pages of the program and of each command. `section`: 1 for commands, 8 for daemons;
/// `version`: for the footer, "anticrack 1.0".
std::vector<Page> manual(const CLI::App& app, int section, const std::string& version);

}  // namespace anticrack::guide
