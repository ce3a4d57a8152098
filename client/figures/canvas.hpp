// SPDX-License-Identifier: GPL-3.0-or-later
//
// The frame of a gnuplot script: its pictures, their size in print and their title.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "figures/figures.hpp"

namespace anticrack::figures {

/// Output of one run of gnuplot. `file` is a bare name in its working folder, of the characters
/// [A-Za-z0-9_.-] and not beginning with "-", or /dev/fd/N; anything else throws.
struct Output {
  Format format;
  std::string file;
  int dpi = 300;      ///< of a PNG
  bool title = true;  ///< written above the panels
};

/// Size of the panels on paper, mm, without the title. Fonts and lines have the same size in print
/// in every picture and format; text is at least 6.5 points.
struct Canvas {
  double width = 0;
  double height = 0;
};

inline constexpr Canvas narrow{85, 68};  ///< a column of a journal
inline constexpr Canvas page{170, 68};   ///< two panels side by side, over both columns
inline constexpr Canvas square{85, 80};  ///< a map of the membrane
inline constexpr Canvas tall{85, 104};   ///< two panels, one above the other

/// Part of the picture, fractions from its lower left corner.
struct Place {
  double x = 0;
  double y = 0;
  double width = 1;
  double height = 1;
};

/// Height of the whole picture over its width, where a place in it has the size of the canvas.
inline double aspect(const Place& place, const Canvas& canvas) {
  return canvas.height / place.height / (canvas.width / place.width);
}

/// The place above a foot, `height` mm of a canvas that has the place, and the foot.
inline std::pair<Place, Place> above_foot(const Place& place, const Canvas& canvas, double height) {
  const double part = place.height * height / canvas.height;
  return {{place.x, place.y + part, place.width, place.height - part},
          {place.x, place.y, place.width, part}};
}

/// The left and the right half.
inline std::pair<Place, Place> halves(const Place& place) {
  const double half = place.width / 2;
  return {{place.x, place.y, half, place.height}, {place.x + half, place.y, half, place.height}};
}

/// The commands that draw the panels into a part of the picture.
using Plots = std::function<std::string(Format, const Place&)>;

/// Of the case and of the load; either may be empty.
struct Title {
  std::string first;
  std::string second;
};

struct Picture {
  std::string data;  ///< blocks of data
  Title title;
  Plots plots;
  Canvas canvas;
};

/// The data once, then for every output the title, wrapped, and what `plots` draws.
std::string script(const Picture& picture, const std::vector<Output>& outputs);

}  // namespace anticrack::figures
