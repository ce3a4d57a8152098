// SPDX-License-Identifier: GPL-3.0-or-later
//
// What figures look like: the options of every command that draws.
#pragma once

#include "figures/figures.hpp"

namespace CLI {
class App;
}

namespace anticrack::cli {

void add_figure_options(CLI::App& app, figures::Options& options);

}  // namespace anticrack::cli
