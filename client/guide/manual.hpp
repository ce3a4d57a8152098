// SPDX-License-Identifier: GPL-3.0-or-later
//
// Manual pages, made from the texts of --help.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace anticrack::guide {

struct Page {
  std::string file;  ///< "anticrack-mesh-create.1"
  std::string text;  ///< in the man macros of roff
};

/// The pages of the program and of each command. `section`: 1 for commands, 8 for daemons;
/// `version`: for the footer, "anticrack 1.0".
std::vector<Page> manual(const CLI::App& app, int section, const std::string& version);

}  // namespace anticrack::guide
