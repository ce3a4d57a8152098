// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shell completion, made from the texts of --help.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace anticrack::guide {

enum class Shell { bash, zsh, fish };

/// A script to source or to install among the shell's completions. It offers commands, options with
/// descriptions (zsh, fish), files for the type FILE, folders for DIR, the words of {a,b,c}.
std::string completion_script(const CLI::App& app, Shell shell);

}  // namespace anticrack::guide
