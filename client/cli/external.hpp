// SPDX-License-Identifier: GPL-3.0-or-later
//
// Commands of other programs: `anticrack NAME` runs anticrack-NAME, or the Python package's command
// of that name, `python3 -m anticrack NAME`.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/session.hpp"

namespace anticrack::cli {

/// What draws is not there, or ended without an answer.
class FiguresError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// anticrack-NAME beside this executable or on PATH; empty where there is none, and for what is no
/// name of a command.
std::filesystem::path external_command(const std::string& name);

/// Becomes the program. Throws std::runtime_error where the system cannot start it.
[[noreturn]] void become(const std::filesystem::path& program, std::vector<std::string> words);

/// Runs a command of the Python package, whose standard input is `input`, waits for it and tells
/// what it has drawn, as files and notes or as the document of --json; its exit code. Python is
/// that of ANTICRACK_PYTHON, else /usr/bin/python3, else the first on PATH; it imports nothing from
/// the current folder, and in a build the package beside this executable's folder. Throws
/// FiguresError.
int run_in_python(std::vector<std::string> words, std::string_view input, const Globals& globals,
                  bool with_document);

}  // namespace anticrack::cli
