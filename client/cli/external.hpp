// SPDX-License-Identifier: GPL-3.0-or-later
//
// Commands of other programs: `anticrack NAME` runs anticrack-NAME, or the command of that name in
// the Python package, `python3 -m anticrack NAME`.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/session.hpp"

namespace anticrack::cli {

/// The error if Python or the package is missing, or ended without an answer.
class FiguresError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// anticrack-NAME beside this executable or on PATH; empty if there is none, or if `name` cannot be
/// that of a command.
std::filesystem::path external_command(const std::string& name);

/// Replaces this process by the program. Throws std::runtime_error if the system cannot start it.
[[noreturn]] void become(const std::filesystem::path& program, std::vector<std::string> words);

/// Runs a command of the Python package with `input` as its standard input, waits for it, and tells
/// what it has made, as files and notes or as the document of --json. Returns its exit code.
/// Python is that of ANTICRACK_PYTHON, else /usr/bin/python3, else the first on PATH. It imports
/// nothing from the current folder, and in a build it imports the package beside the folder of this
/// executable. Throws FiguresError.
int run_in_python(std::vector<std::string> words, std::string_view input, const Globals& globals,
                  bool with_document);

}  // namespace anticrack::cli
