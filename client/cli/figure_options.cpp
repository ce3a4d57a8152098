// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/options.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace anticrack::cli {
namespace {

using figures::Format;

Format format_of(const std::string& name) {
  if (name == "png") return Format::png;
  if (name == "svg") return Format::svg;
  if (name == "pdf") return Format::pdf;
  throw CLI::ValidationError("--format", "\"" + name + "\" is none of png, svg and pdf");
}

/// "png,svg": each once.
std::vector<Format> formats_of(const std::string& list) {
  std::vector<Format> formats;
  std::istringstream names(list);
  for (std::string name; std::getline(names, name, ',');) {
    const Format format = format_of(name);
    if (std::count(formats.begin(), formats.end(), format) == 0) formats.push_back(format);
  }
  if (formats.empty()) format_of("");
  return formats;
}

}  // namespace

void add_figure_options(CLI::App& app, figures::Options& options) {
  app.add_option_function<std::string>(
         "--format", [&options](const std::string& list) { options.formats = formats_of(list); },
         "Of png, svg and pdf those to write, separated by commas")
      ->type_name("LIST")
      ->default_str("png,svg");
  app.add_option("--dpi", options.dpi, "Dots an inch of PNG files; a single panel is 85 mm wide")
      ->check(CLI::Range(50, 1200))
      ->capture_default_str();
  app.add_flag_callback(
      "--no-titles", [&options] { options.titles = false; },
      "Leave out the titles of case and load, for papers with captions");
}

}  // namespace anticrack::cli
