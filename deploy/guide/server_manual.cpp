// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints the manual page anticrackd(8), made from the texts of --help. Used by the build only.
#include <CLI/CLI.hpp>

#include <iostream>

#include "app/command_line.hpp"
#include "guide/guide.hpp"

int main() {
  using namespace anticrack;
  CLI::App parser;
  app::CommandLine unused;
  app::describe(parser, unused, ANTICRACK_VERSION);
  for (const guide::Page& page : guide::manual(parser, 8, "anticrack " ANTICRACK_VERSION))
    std::cout << page.text;
  std::cout << ".SH SEE ALSO\n.BR anticrackd.toml (5),\n.BR anticrack (1)\n" << std::flush;
  return std::cout ? 0 : 1;
}
