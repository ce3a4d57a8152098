// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is wrong with a command line.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace anticrack::cli {

/// One sentence of a command line (without the program's name) that `app` did not take: the
/// command, the bad word and the cure. CLI11's `error` serves where it knows better.
std::string usage_text(CLI::App& app, const CLI::ParseError& error,
                       const std::vector<std::string>& words);

}  // namespace anticrack::cli
