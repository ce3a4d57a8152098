// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/palette.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "figures/text.hpp"

namespace anticrack::figures {

std::string colour(Palette palette, double part, double brightness) {
  const double at = std::clamp(part, 0.0, 1.0) * static_cast<double>(palette.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), palette.size() - 2);
  const double along = at - static_cast<double>(below);
  const auto byte = [&](std::size_t c) {
    const double value = std::lerp(palette[below][c], palette[below + 1][c], along);
    return static_cast<unsigned>(std::lround(value * brightness));
  };
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "0x%02x%02x%02x", byte(0), byte(1), byte(2));
  return text.data();
}

std::string colour_bar(Palette palette, const Range& range) {
  std::string text = "set palette defined (";
  for (std::size_t i = 0; i < palette.size(); ++i) {
    const std::string shade =
        colour(palette, static_cast<double>(i) / static_cast<double>(palette.size() - 1));
    text += (i == 0 ? "" : ", ") + std::to_string(i) + " '#" + shade.substr(2) + "'";
  }
  return text + ")\nset cbrange [" + number(range.low) + ":" + number(range.high) +
         "]\nset cbtics " + number(label_step(range, 4)) + " font ',7' textcolor rgb '#333333'\n";
}

}  // namespace anticrack::figures
