// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack show | plot | export: the commands that need a result file and no server
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/external.hpp"
#include "cli/job_run.hpp"
#include "cli/json.hpp"
#include "cli/report.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"
#include "output/file.hpp"
#include "results/file.hpp"
#include "results/result.hpp"
#include "words/nearest.hpp"

namespace anticrack::cli {
namespace {

struct ShowOptions {
  std::string file;
  std::vector<std::string> loads;  ///< empty: all
  std::string csv;
  bool inclusions = false, boundary = false, probes = false, tips = false, growth = false,
       all = false;
};

/// A command of the Python package, with the words that are passed on.
struct PassedOn {
  std::string command, file;
  std::vector<std::string> loads, words;
};

// The result with the requested loads, in their order.
results::Result read_result(const ShowOptions& options) {
  results::Result result = results::read(options.file);
  if (options.loads.empty()) return result;
  std::vector<std::string> names;
  for (const results::Load& load : result.loads) names.push_back(load.name());
  std::vector<results::Load> chosen;
  for (const std::string& name : options.loads) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw results::Error(options.file, "there is no load " + name,
                           names.empty() ? "it keeps traces of no row; run the sweep with --traces"
                                         : words::suggestion(name, names));
    }
    chosen.push_back(result.loads[static_cast<std::size_t>(found - names.begin())]);
  }
  result.loads = std::move(chosen);
  result.sweep.reset();  // the loads are some of its rows
  return result;
}

void add_file(CLI::App& command, std::string& file, std::vector<std::string>& loads,
              const char* help) {
  add_value(command, "RESULT", file, "FILE", help)->required();
  add_value(command, "--load", loads, "NAME",
            "This load only, of a sweep row-K; again for more (default: all)");
}

int show_study(const ShowOptions& options, const Globals& globals) {
  const auto program = external_command("study");
  if (program.empty() || !options.csv.empty() || !options.loads.empty()) throw;
  std::vector<std::string> words{program, "--show", options.file};
  if (globals.json) words.emplace_back("--json");
  become(std::move(words));
}

int show_file(const ShowOptions& options, const Globals& given) try {
  const Globals globals = with_outputs(given, {options.csv});
  const std::filesystem::path csv = csv_file(options.csv, options.file);
  const results::Result result = read_result(options);
  if (!csv.empty()) output::write_file(csv, answers_csv(result));
  if (globals.json) {
    print_document(answers_json(result, options.file));
    return exit_ok;
  }
  std::string head;
  if (!result.title.empty()) head += sanitise(result.title) + "\n";
  head += fmt::format("{} triangles, {} nodes ({}), solved by {}\n\n", result.mesh.triangle_count(),
                      result.mesh.node_count(), sanitise(result.mesh.name()),
                      sanitise(result.job_name));
  std::string foot;
  if (!result.not_reached.empty()) foot = "not reached: " + sanitise(result.not_reached) + "\n";
  if (result.loads.size() == 1 || !options.loads.empty())
    for (const results::Load& load : result.loads) foot += stages_table(load);
  print_answer(globals, head +
                            (options.tips         ? tips_table(result.loads, result.units, true)
                             : options.growth     ? growth_table(result.loads, result.units, true)
                             : options.inclusions ? inclusions_table(result)
                             : options.boundary   ? list_table(result, "boundary")
                             : options.probes     ? list_table(result, "probes")
                                                  : answers_table(result)) +
                            (options.all ? numbers_table(result) : "") + foot);
  return exit_ok;
} catch (const results::IsStudy&) {
  return show_study(options, given);
}

int pass_to_python(const PassedOn& options, const Globals& globals) {
  std::vector<std::string> words = options.words;
  words.insert(words.begin(), options.command);
  for (const std::string& load : options.loads) words.push_back("--load=" + load);
  words.insert(words.end(), {"--", options.file});
  become_python(std::move(words), globals);
}

void add_plot(CLI::App& app, const Globals& globals, Command& chosen) {
  const auto options = std::make_shared<PassedOn>(PassedOn{"plot", "", {}, {}});
  CLI::App* command = app.add_subcommand("plot", "Draw the figures of a result file");
  add_file(*command, options->file, options->loads, "Result file, HDF5");
  add_figure_options(*command, options->words, "Folder of the figures (default: figures)");
  const auto add = [&](const char* flag, const char* type, const char* help) {
    return pass_on(*command, options->words, flag, type, help);
  };
  CLI::Option* together = add(
      "--together", "", "One figure, together, of up to 8 loads over each other on one interface");
  add("--only", "LIST",
      "Of overview, membrane, plan, traces, convergence, accuracy and growth those to draw, "
      "separated by commas (default: all that have something to show)")
      ->excludes(together);
  add("--animate", "WHAT",
      "Animations in place of figures: loads (one after another), amplitude (u grows to its size "
      "and back), stages or growth; --format is of gif, webp and mp4 then");
  add("--interface", "NAME",
      "Draw the traces of this interface, also in the overview and with --together (default: of "
      "all that can open; in the overview of the one that opens most, and the pressure of one in "
      "contact)");
  add("--all", "",
      "However many there are: without it, of more than 12 loads the first 12 are drawn, and of "
      "more than 12 interfaces the traces of the most eventful");
  add("--amplify", "FACTOR", "By how much u is amplified in the membrane, the same in all figures");
  add("--limits", "LOW,HIGH",
      "Of the colours of u in the membrane, the same in all figures, as --limits=-0.1,0.4");
  command->footer(
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
  on(*command, options, globals, chosen, pass_to_python);
}

}  // namespace

void add_files(CLI::App& app, const Globals& globals, Command& chosen) {
  const auto options = std::make_shared<ShowOptions>();
  CLI::App* show_command = app.add_subcommand("show", "Show the answers of a result file");
  add_file(*show_command, options->file, options->loads, "Result file, HDF5");
  const auto add = [show_command](const char* flag, bool& given, const char* help) {
    show_command->add_flag(flag, given, help);
  };
  add("--inclusions", options->inclusions,
      "A row for each inclusion of each load case, also of many");
  add("--boundary", options->boundary,
      "The force on each side and hole of the boundary in each load case");
  add("--probes", options->probes, "u at each point of the probes of the case in each load case");
  add("--tips", options->tips,
      "A row for each tip of a crack or an inclusion of each load case, also of many");
  add("--growth", options->growth, "A row for each position of cracks and delaminations that grow");
  add("--all", options->all,
      "Also every number of the mesh, a sweep and each load case, with its unit and what it is");
  add_value(*show_command, "--csv", options->csv, "FILE.csv",
            "Also write comma-separated text, one line per load case and inclusion; of a sweep one "
            "per row");
  show_command->footer(
      "Of one load, or with --load, also the stages of a job with an accuracy.\n\n"
      "Example:\n  anticrack show paper.h5\n"
      "  anticrack show fibres.h5 --inclusions --csv fibres.csv");
  on(*show_command, options, globals, chosen, show_file);

  add_plot(app, globals, chosen);

  CLI::App* export_command =
      app.add_subcommand("export", "Export a result file to .vtu and .pvd, for ParaView");
  const auto passed = std::make_shared<PassedOn>(PassedOn{"export", "", {}, {}});
  add_file(*export_command, passed->file, passed->loads, "Result file, HDF5, with fields");
  pass_on(*export_command, passed->words, "-o,--output", "DIR", "Folder of the files")->required();
  export_command->footer(
      "The membrane needs u on every node: run the case with [output] fields = true, or fetch its\n"
      "job with --fields (anticrack job fetch). To see it deformed, apply the filter Warp By "
      "Scalar\n"
      "to u. Where the result has them, each triangle has its error_indicator.\n"
      "The Python package anticrack writes the files.\n\n"
      "Example:\n  anticrack export paper.h5 -o paraview");
  on(*export_command, passed, globals, chosen, pass_to_python);
}

}  // namespace anticrack::cli
