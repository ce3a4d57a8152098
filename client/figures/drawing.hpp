// SPDX-License-Identifier: GPL-3.0-or-later
//
// Draws pictures into a folder. For the sources of this folder only.
#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "figures/canvas.hpp"
#include "figures/figures.hpp"

namespace anticrack::figures {

class Drawing {
 public:
  /// Creates the folder if missing; throws output::Error where it is not writable.
  Drawing(std::filesystem::path folder, Options options);

  /// Draws STEM.png, STEM.svg, ..., as the options say, each completely or not at all.
  void draw(const std::string& stem, const Picture& picture);

  Drawn drawn;

 private:
  std::filesystem::path _folder;
  Options _options;
};

/// gnuplot's SVG without its empty groups: it opens several per triangle, most of the file and slow
/// to display. Expects gnuplot's lines, which begin with one tag each. O(length).
std::string without_empty_groups(std::string_view svg);

/// Runs gnuplot in `folder` with `script` as its standard input and waits for it. It reads no
/// start-up files of the user and starts with default signals. Throws Error when gnuplot is not
/// installed, fails (with what it printed) or takes longer than `limit` (it is killed).
/// The descriptors `kept` are its own, too, as /dev/fd/N.
void run_gnuplot(const std::string& script, const std::filesystem::path& folder,
                 std::chrono::milliseconds limit, std::span<const int> kept = {});

}  // namespace anticrack::figures
