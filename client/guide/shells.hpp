// SPDX-License-Identifier: GPL-3.0-or-later
//
// A script for each shell. All read a command line alike: a word that names a subcommand of the
// current command leads to it, other words are skipped.
#pragma once

#include <string>

#include "guide/command_tree.hpp"

namespace anticrack::guide {

/// The script that completes commands, options and their values.
std::string bash_script(const Command& program);
std::string zsh_script(const Command& program);
std::string fish_script(const Command& program);

/// 'text', as all three shells read it back.
std::string shell_word(const std::string& text);

/// The words with `separator` between.
std::string joined(const std::vector<std::string>& words, const std::string& separator = " ");

/// Names of all options that take a value: the word after one is not a command.
std::vector<std::string> with_value(const Command& program);

/// Its value; no command has a second positional.
Value first_positional(const Command& command);

/// Options of the command, and of the program, which may stand after any command.
std::vector<Option> options_of(const Command& command, const Command& program);

}  // namespace anticrack::guide
