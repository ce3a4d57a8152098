// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack study | view: commands whose programs are those of the Python package. They read the
//   words themselves; what is said of them here is for help, manual and completion.
#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/external.hpp"
#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

struct Word {
  const char *name, *type, *help;  ///< no type: a flag
};

void add_program(CLI::App& app, Command& chosen, const std::vector<std::string>& words,
                 const std::string& name, const char* help, const std::vector<Word>& options,
                 const char* below) {
  CLI::App* command = app.add_subcommand(name, help);
  const auto ignore = [](const auto&) {};
  for (const auto& [name_of, type, told] : options) {
    if (*type == '\0')
      command->add_flag(name_of, told);
    else if (std::string(type) != "KEY=VALUE")
      command->add_option_function<std::string>(name_of, ignore, told)->type_name(type);
    else
      command->add_option_function<std::vector<std::string>>(name_of, ignore, told)
          ->allow_extra_args(false)
          ->type_name(type);
  }
  command->footer(below);
  command->callback([&chosen, words, name] {
    chosen = [line = words, name]() mutable -> int {
      line.insert(line.begin(), external_command(name).string());
      if (line[0].empty())
        throw UsageError("anticrack-" + name + " is not installed; install python3-anticrack");
      become(line);
    };
  });
}

}  // namespace

void add_programs(CLI::App& app, const std::vector<std::string>& words, Command& chosen) {
  add_program(app, chosen, words, "study", "Solve a case for many values of its keys",
              {{"CASE", "FILE", "The case, a TOML file"},
               {"--vary", "KEY=VALUE", "FIRST:LAST:COUNT or VALUE,VALUE,...; again for more keys"},
               {"--csv", "FILE", "Rows: a line of keys, then a line of values for each row"},
               {"--set", "KEY=VALUE", "A value for all rows"},
               {"-o,--output", "FILE", "The study, HDF5; its rows are not solved again"},
               {"--jobs", "COUNT", "So many at once (default: 4)"},
               {"--dry-run", "", "Solve nothing, but say what would be solved"},
               {"--yes", "", "Do not ask before many meshes are made"},
               {"--retry", "", "Solve rows that failed again"},
               {"--show", "FILE", "Only show a study"}},
              "All combinations of the --vary are solved, for each row of --csv, each as a job of "
              "its own.\n"
              "Run again after Ctrl-C or a crash, it goes on from FILE.\n\n"
              "Example:\n"
              "  anticrack --local study sheet.toml --vary mesh.size=0.1,0.05 -o sizes.h5\n"
              "  anticrack show sizes.h5\n  anticrack view sizes.h5");
  add_program(
      app, chosen, words, "view", "Show jobs and results in a browser",
      {{"WHAT", "FILE", "A result, a study, jobs/ID, or a case, which is run"},
       {"--port", "PORT", "Of this machine (default: a free one)"},
       {"--no-browser", "", "Print the address and open nothing"},
       {"--until-closed", "", "End when the last page has been closed"}},
      "Only this machine is served, and only the browser that opens the printed address.\n\n"
      "Example:\n  anticrack view opening.h5\n  anticrack --local view case.toml");
}

}  // namespace anticrack::cli
