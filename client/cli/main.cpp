// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_line.hpp"
#include "output/standard.hpp"

int main(int argc, char** argv) {
  anticrack::output::prepare_process();
  return anticrack::cli::run_command_line(argc, argv);
}
