// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>

#include <string>

#include "cli/options.hpp"

namespace anticrack::cli {

void add_figure_options(CLI::App& app, FigureOptions& options) {
  app.add_option("-o,--output", options.folder, options.folder_help)->type_name("DIR");
  app.add_option("--format", options.format,
                 "Of png, svg and pdf those to write, separated by commas")
      ->type_name("LIST")
      ->default_str("png,svg");
  app.add_option("--dpi", options.dpi,
                 "Dots an inch of PNG files, and of images in the others, from 50 to 1200")
      ->type_name("INT")
      ->default_str("300");
  app.add_option("--width", options.width,
                 "Width of a panel, mm, a column of most journals; two are side by side in an "
                 "overview")
      ->type_name("MM")
      ->default_str("85");
  app.add_option("--font", options.font, "Family of the letters (default: DejaVu Sans)")
      ->type_name("NAME");
  app.add_flag("--no-titles", options.no_titles,
               "Leave out the titles of case, load and panels, for papers with captions");
}

std::vector<std::string> words_of(const FigureOptions& options) {
  std::vector<std::string> words;
  for (const auto& [name, value] : {std::pair{"--output=", options.folder},
                                    {"--format=", options.format},
                                    {"--dpi=", options.dpi},
                                    {"--width=", options.width},
                                    {"--font=", options.font}})
    if (value) words.push_back(name + *value);
  if (options.no_titles) words.emplace_back("--no-titles");
  return words;
}

}  // namespace anticrack::cli
