// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>

#include "cli/commands.hpp"

namespace anticrack::cli {

CLI::Option* pass_on(CLI::App& command, std::vector<std::string>& words, const std::string& flag,
                     const std::string& type, const std::string& help,
                     const std::string& if_absent) {
  const std::string name = flag.substr(flag.rfind(',') + 1);
  if (type.empty())
    return command.add_flag_callback(
        flag, [&words, name] { words.push_back(name); }, help);
  const auto pass = [&words, name](const std::string& value) {
    words.push_back(name + "=" + value);
  };
  CLI::Option* option = command.add_option_function<std::string>(flag, pass, help);
  if (!if_absent.empty()) option->default_str(if_absent);
  return option->type_name(type);
}

void add_figure_options(CLI::App& command, std::vector<std::string>& words,
                        const std::string& folder_help) {
  pass_on(command, words, "-o,--output", "DIR", folder_help);
  pass_on(command, words, "--format", "LIST",
          "Of png, svg and pdf those to write, separated by commas", "png,svg");
  pass_on(command, words, "--dpi", "INT",
          "Dots an inch of PNG files, and of images in the others, from 50 to 1200", "300");
  pass_on(command, words, "--width", "MM",
          "Width of a panel, mm, a column of most journals; two are side by side in an overview",
          "85");
  pass_on(command, words, "--font", "NAME", "Family of the letters (default: DejaVu Sans)");
  pass_on(command, words, "--no-titles", "",
          "Leave out the titles of case, load and panels, for papers with captions");
}

}  // namespace anticrack::cli
