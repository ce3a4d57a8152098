// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds and starts other programs; `anticrack NAME` runs anticrack-NAME, or the command of that
// name in the Python package, `python3 -m anticrack NAME`.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/session.hpp"

namespace anticrack::cli {

/// The path of this executable, with all links resolved.
std::filesystem::path this_program();

/// The program of this name beside `executable`, else the first on `search_path` (like PATH); empty
/// if there is none.
std::filesystem::path find_program(const std::string& name, const std::filesystem::path& executable,
                                   const std::string& search_path);

/// The same, beside this executable or on PATH.
std::filesystem::path find_program(const std::string& name);

/// Starts words[0] with these words and default signals. Its descriptor i is descriptors[i].
/// `flags`: for posix_spawnattr_setflags, besides those of signals. `error`: set to 0, or to the
/// errno if it could not start.
pid_t spawn(std::vector<std::string> words, std::span<const int> descriptors,
            char* const* environment, short flags, int& error);

/// The error if Python is missing, or the system cannot start a program.
class FiguresError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// anticrack-NAME beside this executable or on PATH; empty if there is none, or if `name` cannot be
/// that of a command.
std::filesystem::path external_command(const std::string& name);

/// Replaces this process by the program words[0].
[[noreturn]] void become(std::vector<std::string> words);

/// Replaces this process by a command of the Python package, which tells what it has made. Python
/// is that of ANTICRACK_PYTHON, else /usr/bin/python3, else the first on PATH. It imports nothing
/// from the current folder, and in a build it imports the package beside the folder of this
/// executable.
[[noreturn]] void become_python(std::vector<std::string> words, const Globals& globals);

/// Runs such a command with `input` as its standard input, and text for users as its output;
/// returns its exit code.
int run_in_python(std::vector<std::string> words, std::string_view input, const Globals& globals);

}  // namespace anticrack::cli
