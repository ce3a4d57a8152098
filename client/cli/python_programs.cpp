// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack plot | export | study | view: commands whose programs are those of the Python
//   package. plot and export pass on what they are given; the others read the command line
//   themselves, and what is said of them here is for help, manual and completion.
#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/programs.hpp"
#include "cli/report.hpp"

namespace anticrack::cli {
namespace {

using Words = std::vector<std::string>;

struct Word {
  const char *name, *type, *help;  ///< no type: a flag
  const char* if_absent = "";
  bool again = false;  ///< it may be given several times
};

/// Adds options and arguments; those that are given become words for a program that checks them.
void add_words(CLI::App& command, Words& words, const std::vector<Word>& table) {
  for (const Word& word : table) {
    const std::string all = word.name, name = all.substr(all.rfind(',') + 1);
    const std::string begin = name.starts_with('-') ? name + "=" : "";
    if (*word.type == '\0') {
      const auto pass = [&words, name] { words.push_back(name); };
      command.add_flag_callback(all, pass, word.help);
      continue;
    }
    const auto pass = [&words, begin](const Words& values) {
      for (const std::string& value : values) words.push_back(begin + value);
    };
    CLI::Option* option = command.add_option_function<Words>(all, pass, word.help)
                              ->allow_extra_args(false)
                              ->type_name(word.type)
                              ->default_str(word.if_absent);
    if (!word.again) option->expected(1);
  }
}

/// With the loads and the file, of plot and export.
std::vector<Word> with_result(std::vector<Word> table, const char* help) {
  table.insert(table.begin(),
               {"--load", "NAME", "This load only, of a sweep row-K; again for more (default: all)",
                "", true});
  table.push_back({"RESULT", "FILE", help});
  return table;
}

CLI::App* add_passed_on(CLI::App& app, const Globals& globals, Command& chosen,
                        const std::string& name, const char* help, const std::vector<Word>& table,
                        const char* below) {
  CLI::App* command = app.add_subcommand(name, help);
  const auto words = std::make_shared<Words>();
  add_words(*command, *words, table);
  command->get_option("RESULT")->required();
  command->footer(below);
  command->callback([&globals, &chosen, words, name] {
    chosen = [&globals, words, name]() -> int {
      words->insert(words->end() - 1, "--");  // the file is the last word
      words->insert(words->begin(), name);
      become_python(*words, globals);
    };
  });
  return command;
}

void add_program(CLI::App& app, Command& chosen, const Words& words, const std::string& name,
                 const char* help, const std::vector<Word>& table, const char* below) {
  static Words unused;
  CLI::App* command = app.add_subcommand(name, help);
  add_words(*command, unused, table);
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

const std::vector<Word> figure_words{
    {"--format", "LIST", "Of png, svg and pdf those to write, separated by commas", "png,svg"},
    {"--dpi", "INT", "Dots an inch of PNG files, and of images in the others, from 50 to 1200",
     "300"},
    {"--width", "MM",
     "Width of a panel, mm, a column of most journals; two are side by side in an overview", "85"},
    {"--font", "NAME", "Family of the letters (default: DejaVu Sans)"},
    {"--no-titles", "", "Leave out the titles of case, load and panels, for papers with captions"}};

std::vector<Word> plot_words() {
  std::vector<Word> words{{"-o,--output", "DIR", "Folder of the figures (default: figures)"}};
  words.insert(words.end(), figure_words.begin(), figure_words.end());
  words.insert(
      words.end(),
      {{"--together", "",
        "One figure, together, of up to 8 loads over each other on one interface"},
       {"--only", "LIST",
        "Of overview, membrane, plan, traces, convergence, accuracy and growth those to draw, "
        "separated by commas (default: all that have something to show)"},
       {"--animate", "WHAT",
        "Animations in place of figures: loads (one after another), amplitude (u grows to its size "
        "and back), stages or growth; --format is of gif, webp and mp4 then"},
       {"--interface", "NAME",
        "Draw the traces of this interface, also in the overview and with --together (default: of "
        "all that can open; in the overview of the one that opens most, and the pressure of one in "
        "contact)"},
       {"--all", "",
        "However many there are: without it, of more than 12 loads the first 12 are drawn, and of "
        "more than 12 interfaces the traces of the most eventful"},
       {"--amplify", "FACTOR",
        "By how much u is amplified in the membrane, the same in all figures"},
       {"--limits", "LOW,HIGH",
        "Of the colours of u in the membrane, the same in all figures, as --limits=-0.1,0.4"}});
  return with_result(words, "Result file, HDF5");
}

}  // namespace

void add_figure_options(CLI::App& command, Words& words) {
  add_words(command, words, {{"-o,--output", "DIR", "Folder for the figure"}});
  add_words(command, words, figure_words);
}

void add_programs(CLI::App& app, const Globals& globals, const Words& words, Command& chosen) {
  CLI::App* plot = add_passed_on(
      app, globals, chosen, "plot", "Draw the figures of a result file", plot_words(),
      "Of every load: LOAD-membrane, LOAD-plan (from above, u and the flux), LOAD-traces (u-, u+\n"
      "and [u] on the interface, and the contact pressure), LOAD-convergence and, of a job with "
      "an\n"
      "accuracy, LOAD-accuracy (error against triangles), of one with growth LOAD-growth (the\n"
      "load against the displacement, G against the front), 85 mm wide, a column of a journal; "
      "and\n"
      "LOAD, an overview. Of a sweep: sweep (A and the contact length), sweep-contact (where the\n"
      "cracks are closed) and the traces of rows that were kept.\n"
      "The Python package anticrack draws them, with matplotlib.\n\n"
      "Example:\n  anticrack plot paper.h5 -o figures\n"
      "  anticrack plot paper.h5 -o figures --format pdf --no-titles\n"
      "  anticrack plot several.h5 -o figures --together --interface middle\n"
      "  anticrack plot several.h5 -o figures --only overview,traces --interface upper");
  plot->get_option("--only")->excludes(plot->get_option("--together"));
  add_passed_on(
      app, globals, chosen, "export", "Export a result file to .vtu and .pvd, for ParaView",
      with_result({{"-o,--output", "DIR", "Folder of the files"}},
                  "Result file, HDF5, with fields"),
      "The membrane needs u on every node: run the case with [output] fields = true, or fetch its\n"
      "job with --fields (anticrack job fetch). To see it deformed, apply the filter Warp By "
      "Scalar\n"
      "to u. Where the result has them, each triangle has its error_indicator.\n"
      "The Python package anticrack writes the files.\n\n"
      "Example:\n  anticrack export paper.h5 -o paraview")
      ->get_option("--output")
      ->required();
  add_program(app, chosen, words, "study", "Solve a case for many values of its keys",
              {{"CASE", "FILE", "The case, a TOML file"},
               {"--vary", "KEY=VALUE", "FIRST:LAST:COUNT or VALUE,VALUE,...; again for more keys",
                "", true},
               {"--csv", "FILE", "Rows: a line of keys, then a line of values for each row"},
               {"--set", "KEY=VALUE", "A value for all rows", "", true},
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
