// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack show RESULT
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/job_run.hpp"
#include "cli/programs.hpp"
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

}  // namespace

void add_show(CLI::App& app, const Globals& globals, Command& chosen) {
  const auto options = std::make_shared<ShowOptions>();
  CLI::App* command = app.add_subcommand("show", "Show the answers of a result file");
  add_value(*command, "RESULT", options->file, "FILE", "Result file, HDF5")->required();
  add_value(*command, "--load", options->loads, "NAME",
            "This load only, of a sweep row-K; again for more (default: all)");
  const auto add = [command](const char* flag, bool& given, const char* help) {
    command->add_flag(flag, given, help);
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
  add_value(*command, "--csv", options->csv, "FILE.csv",
            "Also write comma-separated text, one line per load case and inclusion; of a sweep one "
            "per row");
  command->footer(
      "Of one load, or with --load, also the stages of a job with an accuracy.\n\n"
      "Example:\n  anticrack show paper.h5\n"
      "  anticrack show fibres.h5 --inclusions --csv fibres.csv");
  on(*command, options, globals, chosen, show_file);
}

}  // namespace anticrack::cli
