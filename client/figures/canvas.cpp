// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/canvas.hpp"

#include <cmath>
#include <stdexcept>

#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

bool is_bare_name(const std::string& file) {
  return !file.empty() && file[0] != '-' &&
         file.find_first_not_of(
             "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-") ==
             std::string::npos;
}

constexpr double mm_per_inch = 25.4;
constexpr double line_height = 4.2;  // of the title, mm

std::string pixels(const Canvas& size, double dpi) {
  return std::to_string(std::lround(size.width * dpi / mm_per_inch)) + "," +
         std::to_string(std::lround(size.height * dpi / mm_per_inch));
}

/// Scales such that a font of 8 points and a line of width 1 are the same in print everywhere.
std::string driver(const Output& output, const Canvas& size) {
  // What gnuplot's font sizes and line widths are made for.
  constexpr double screen_dpi = 96;
  constexpr double points_per_inch = 72;
  switch (output.format) {
    case Format::png: {
      const std::string scale = number(output.dpi / screen_dpi);
      return "pngcairo enhanced dashlength 2 background rgb 'white' fontscale " + scale +
             " linewidth " + scale + " pointscale " + scale + " size " + pixels(size, output.dpi);
    }
    case Format::svg:
      return "svg enhanced background rgb 'white' dynamic fontscale " +
             number(screen_dpi / points_per_inch) + " size " + pixels(size, screen_dpi);
    case Format::pdf:
      break;
  }
  return "pdfcairo enhanced background rgb 'white' dashlength 2 fontscale 0.75 linewidth 1.5 "
         "size " +
         number(size.width / 10) + "cm," + number(size.height / 10) + "cm";
}

std::string behind(const std::string& text, std::string_view prefix) {
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

std::string terminal(const Output& output, const Canvas& size) {
  if (!is_bare_name(behind(output.file, "/dev/fd/")))
    throw std::invalid_argument("\"" + output.file +
                                "\" is no bare name of a file and no descriptor");
  return "set terminal " + driver(output, size) + " font 'DejaVu Sans,8'\nset output '" +
         output.file + "'\n";
}

std::vector<std::string> title_lines(const Title& title, std::size_t most) {
  std::vector<std::string> lines = wrapped(title.first, most, 2);
  if (title.second.empty()) return lines;
  const std::string joined =
      lines.empty() ? std::string() : lines.back() + " \xE2\x80\x94 " + title.second;
  if (lines.empty() || length(joined) > most)
    lines.push_back(title.second);
  else
    lines.back() = joined;
  return lines;
}

}  // namespace

std::string script(const Picture& picture, const std::vector<Output>& outputs) {
  constexpr double character_width = 1.85;  // mm, of the title's font
  const Canvas& canvas = picture.canvas;
  const auto most = static_cast<std::size_t>(canvas.width / character_width);
  std::string text = "set encoding utf8\n" + picture.data;
  for (const Output& output : outputs) {
    const auto lines = output.title ? title_lines(picture.title, most) : std::vector<std::string>{};
    const double head = lines.empty() ? 0 : 1 + line_height * static_cast<double>(lines.size());
    const Canvas size{canvas.width, canvas.height + head};
    text += "reset\nset encoding utf8\nset minussign\n" + terminal(output, size);
    text += "set multiplot\n";
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const double from_top = 1 + line_height * (static_cast<double>(i) + 0.5);
      text += "set label " + std::to_string(101 + i) + " " + quoted(lines[i], most) +
              " at screen 0.5, screen " + number(1 - from_top / size.height) +
              " center noenhanced font ',9' textcolor rgb '#222222'\n";
    }
    text += picture.plots(output.format, {0, 0, 1, canvas.height / size.height});
    text += "unset multiplot\nset output\n";
  }
  return text;
}

}  // namespace anticrack::figures
