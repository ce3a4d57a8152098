// SPDX-License-Identifier: GPL-3.0-or-later
//
// Draws pictures into a folder. For the sources of this folder only.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/figures.hpp"

namespace anticrack::figures {

class Drawing {
 public:
  /// Creates the folder if missing; throws results::Error where it is not writable.
  Drawing(std::filesystem::path folder, Options options);

  /// Draws STEM.png, STEM.svg, ..., as the options say, each under a temporary name first.
  void draw(const std::string& stem, const Picture& picture);

  Drawn drawn;

 private:
  std::filesystem::path _folder;
  Options _options;
};

}  // namespace anticrack::figures
