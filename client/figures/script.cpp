// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/script.hpp"

#include <functional>
#include <stdexcept>

#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;
using results::Result;

struct Canvas {
  int width = 0;  // pixels
  int height = 0;
};

constexpr Canvas single{1400, 1000};
constexpr Canvas wide{2000, 960};

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

using Plots = std::function<std::string(Format)>;

/// `data` once, then for every output: the title and what `plots` draws.
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

std::string title_of(const Result& result, const Load& load) {
  return quoted(result.title.empty() ? load.name : result.title + " \xE2\x80\x94 " + load.name, 90);
}

}  // namespace

std::string membrane_script(const Result& result, const Load& load, const Surface& surface,
                            const std::vector<Output>& outputs) {
  return script(
      membrane_data(surface), title_of(result, load),
      [&](Format format) {
        return membrane_panel(surface, membrane_view(result), {0, 0, 1, 0.93}, format);
      },
      single, outputs);
}

std::string traces_script(const Result& result, const Load& load, std::size_t interface,
                          const std::vector<Output>& outputs) {
  const Profile along = profile(result.interfaces.at(interface), load.traces.at(interface));
  return script(
      traces_data(along, load.traces[interface]), title_of(result, load),
      [&](Format) {
        return traces_panel(along, load, {0, 0, 1, 0.93});
      },
      single, outputs);
}

std::string convergence_script(const Result& result, const Load& load,
                               const std::vector<Output>& outputs) {
  return script(
      convergence_data(load), title_of(result, load),
      [&](Format) {
        return convergence_panel(load, {0, 0, 1, 0.93});
      },
      single, outputs);
}

std::string combined_script(const Result& result, const Load& load, const Surface& surface,
                            const std::vector<Output>& outputs) {
  const Profile along = profile(result.interfaces.at(0), load.traces.at(0));
  return script(
      membrane_data(surface) + traces_data(along, load.traces[0]), title_of(result, load),
      [&](Format format) {
        return membrane_panel(surface, membrane_view(result), {0, 0, 0.5, 0.93}, format) +
               traces_panel(along, load, {0.5, 0, 0.5, 0.93});
      },
      wide, outputs);
}

}  // namespace anticrack::figures
