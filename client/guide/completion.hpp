// SPDX-License-Identifier: GPL-3.0-or-later
//
// Completion of the command line in shells, made from the texts of --help.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace anticrack::guide {

enum class Shell { bash, zsh, fish };

/// A script for the shell to source or to find among its completions. It offers commands, options
/// with their descriptions (zsh, fish), files where an option's or a positional's type is FILE,
/// folders where it is DIR, and the words of a type that is written {a,b,c}.
std::string completion_script(const CLI::App& app, Shell shell);

}  // namespace anticrack::guide
