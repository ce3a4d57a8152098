// SPDX-License-Identifier: GPL-3.0-or-later
//
// A script for each shell. They share how a command line is read: words that name a command below
// the one so far lead down to it, all others are passed over.
#pragma once

#include <string>

#include "guide/command_tree.hpp"

namespace anticrack::guide {

/// What the shell reads to complete commands, options and their values.
std::string bash_script(const Command& program);
std::string zsh_script(const Command& program);
std::string fish_script(const Command& program);

/// 'text', as all three shells read it back.
std::string shell_word(const std::string& text);

/// Of the options of all commands that take a value: what follows one is not a command.
std::vector<std::string> with_value(const Command& program);

/// No command has a second one.
Value first_positional(const Command& command);

/// Of the command, and of the program: they may stand behind any command.
std::vector<Option> options_of(const Command& command, const Command& program);

}  // namespace anticrack::guide
