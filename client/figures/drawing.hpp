// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pictures on their way into a folder. For the sources of this folder only.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/figures.hpp"

namespace anticrack::figures {

class Drawing {
 public:
  /// Makes the folder if it is missing; throws results::Error where it cannot be written.
  Drawing(std::filesystem::path folder, Options options);

  /// Runs the script for STEM.png, STEM.svg, ..., as the options ask; all are written under
  /// temporary names first.
  void draw(const std::string& stem,
            const std::function<std::string(const std::vector<Output>&)>& script);

  Drawn drawn;

 private:
  std::filesystem::path _folder;
  Options _options;
};

}  // namespace anticrack::figures
