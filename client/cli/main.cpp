// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.hpp"

int main(int argc, char** argv) { return anticrack::cli::run_command_line(argc, argv); }
