// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shell completion, from the texts of --help. The scripts know nothing of the commands: they ask
// `anticrack --complete WORD...` what may replace the last word.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace anticrack::guide {

enum class Shell { bash, zsh, fish };

/// The script, to be sourced or installed among the shell's completions.
std::string_view completion_script(Shell shell);

/// Completions for the words after the program's name: lines "WORD<tab>DESCRIPTION" of commands,
/// options or values that begin like the last word; ":files" or ":folders" if a path is wanted. A
/// word that names a subcommand of the current command leads to it; other words are skipped.
/// `keys`: returns the keys of cases, called if one is wanted.
std::string completions(const CLI::App& app, const std::vector<std::string>& words,
                        const std::function<std::vector<std::string>()>& keys);

}  // namespace anticrack::guide
