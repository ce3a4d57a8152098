// SPDX-License-Identifier: GPL-3.0-or-later
//
// The frame of a gnuplot script: its pictures, their size and their title.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "figures/panels.hpp"

namespace anticrack::figures {

/// Where one run of gnuplot draws to. `file` is a bare name in its working folder, of the
/// characters [A-Za-z0-9_.-] and not beginning with "-"; anything else throws.
struct Output {
  Format format;
  std::string file;
};

struct Canvas {
  int width = 0;  ///< pixels
  int height = 0;
};

inline constexpr Canvas single{1400, 1000};
inline constexpr Canvas wide{2000, 960};

using Plots = std::function<std::string(Format)>;

/// `data` once, then for every output: the title (made by `quoted`) and what `plots` draws.
std::string script(const std::string& data, const std::string& title, const Plots& plots,
                   const Canvas& canvas, const std::vector<Output>& outputs);

}  // namespace anticrack::figures
