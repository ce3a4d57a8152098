// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/canvas.hpp"

#include <stdexcept>

namespace anticrack::figures {
namespace {

bool is_bare_name(const std::string& file) {
  if (file.empty() || file[0] == '-') return false;
  for (const char c : file) {
    const bool plain = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '.' || c == '-';
    if (!plain) return false;
  }
  return true;
}

/// The same size to the eye: pngcairo counts points, svg pixels.
int font_size(Format format) {
  return format == Format::png ? 17 : 22;
}

std::string terminal(const Output& output, const Canvas& canvas) {
  if (!is_bare_name(output.file)) {
    throw std::invalid_argument("\"" + output.file + "\" is not a bare file name");
  }
  const std::string size = std::to_string(canvas.width) + "," + std::to_string(canvas.height);
  const std::string driver = output.format == Format::png
                                 ? "pngcairo enhanced background rgb 'white' linewidth 1.5"
                                 : "svg enhanced background rgb 'white' linewidth 1.5";
  return "set terminal " + driver + " font 'DejaVu Sans," +
         std::to_string(font_size(output.format)) + "' size " + size + "\nset output '" +
         output.file + "'\n";
}

}  // namespace

std::string script(const std::string& data, const std::string& title, const Plots& plots,
                   const Canvas& canvas, const std::vector<Output>& outputs) {
  std::string text = "set encoding utf8\n" + data;
  for (const Output& output : outputs) {
    text += "reset\nset encoding utf8\n" + terminal(output, canvas);
    text += "set multiplot\n";
    const std::string size = std::to_string(font_size(output.format) + 4);
    text += "set label 1 " + title;
    text += " at screen 0.5, 0.965 center noenhanced font 'DejaVu Sans," + size;
    text += "' textcolor rgb '#222222'\n";
    text += plots(output.format);
    text += "unset multiplot\nset output\n";
  }
  return text;
}

}  // namespace anticrack::figures
