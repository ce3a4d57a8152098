// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack sweep CASE.toml --coefficients FILE
#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

#include "cli/commands.hpp"
#include "cli/job_run.hpp"
#include "cli/report.hpp"
#include "cli/sweep_input.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "output/file.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;

struct SweepOptions {
  std::string case_file;
  SweepFiles files;
  std::string output;
  std::string csv;
  bool detach = false;
  std::vector<std::string> overrides;
};

Case read_case(Session& session, const SweepOptions& options) {
  const bool nodal = !options.files.nodal.empty();
  Case the_case = read_case(session, options.case_file, options.overrides,
                            nodal ? Loads::optional : Loads::needed);
  if (nodal && the_case.spec.load_cases_size() > 0) {
    say(session.globals(),
        "The loads of the case are not used: each row of " + options.files.nodal + " is a load");
  }
  if (leave_out_accuracy(the_case)) {
    say(session.globals(),
        "[accuracy] is not used: a sweep has one mesh, of mesh.size; --bounds tells how far each "
        "row is from the membrane. For closer bounds take a smaller mesh.size, or write few rows "
        "as [[load]]s and use run");
  }
  return the_case;
}

// Checks nodal rows, which is possible only against an existing mesh.
void check_mesh(Session& session, const Case& the_case, const SweepInput& input) {
  if (!input.nodal()) return;
  const v1::Mesh mesh = follow_mesh(session, create_mesh(session, the_case).name());
  if (mesh.state() != v1::Mesh::STATE_FAILED)  // otherwise the job gives the reason
    check_nodes(input, mesh.node_count());
}

void add_matrix(Session& session, const SweepInput& input, v1::JobSpec& spec) {
  v1::Sweep::Matrix& matrix = matrix_of(input, spec);
  if (input.bytes() > inline_matrix_bytes) {
    matrix.set_upload(client::upload_array(session.connection(), input.values, session.stop()));
    return;
  }
  const void* first = input.values.data();
  matrix.set_packed(first, input.bytes());
}

void save_csv(const fs::path& csv, const results::Sweep& sweep, const Globals& globals) {
  if (csv.empty()) return;
  output::write_file(csv, sweep_csv(sweep));
  say(globals, "Rows: " + csv.string());
}

/// The files for the answers; empty paths are not written.
struct Targets {
  fs::path result;
  fs::path csv;
};

Targets check_targets(const SweepOptions& options) {
  Targets targets;
  if (!options.detach) targets.result = result_file(options.case_file, options.output);
  targets.csv = csv_file(options.csv, targets.result);
  return targets;
}

int sweep(const SweepOptions& options, const Globals& given) {
  const Globals globals = with_outputs(given, {options.output, options.csv});
  const auto begin = std::chrono::steady_clock::now();
  Session session(globals);
  Case the_case = read_case(session, options);
  SweepInput input = read_sweep_input(options.files, the_case);
  const Targets targets = check_targets(options);
  make_sweep(input, the_case);
  check_mesh(session, the_case, input);
  const Prepare prepare = [&](v1::JobSpec& spec) { add_matrix(session, input, spec); };
  if (options.detach) {
    tell_submitted(session, submit(session, the_case, client::make_uuid(), prepare));
    return exit_ok;
  }
  const auto complete = [&](results::Result& result) {
    result.sweep.value().source = input.source();
    if (!input.nodal())
      result.sweep->columns["coefficients"] =
          results::array_of(std::move(input.values), {input.columns});
  };
  const auto saved = [&](const results::Result& result) {
    save_csv(targets.csv, *result.sweep, globals);
    for (const std::string& warning : result.sweep->answer.warnings())
      say(globals, "warning: " + sanitise(warning));
  };
  return run_job(session, the_case, targets.result, begin, {prepare, input.rows, complete, saved});
}

void add_options(CLI::App& command, SweepOptions& options) {
  add_case(command, options.case_file);
  CLI::Option_group& input = *command.add_option_group("Load cases");
  add_value(input, "--coefficients,--combinations", options.files.coefficients,
            "FILE.csv|FILE.h5:/PATH",
            "One row per load case: the coefficients of the case's loads. Comma-separated text (or "
            "with semicolons, and then decimal commas, too), optionally with a first line of their "
            "names, or a dataset (rows,loads) of an HDF5 file (default /coefficients), optionally "
            "with their names as attribute loads");
  add_value(input, "--nodal", options.files.nodal, "FILE.h5:/PATH",
            "One row per load case: f on the nodes of the mesh. A dataset (rows,nodes)");
  input.require_option(1);
  add_value(command, "--traces", options.files.traces, "ROWS",
            "Rows, from 0, whose traces are kept: all, none, or for example 0,10,20-30")
      ->capture_default_str();
  command.add_flag(
      "--bounds", options.files.bounds,
      "Bounds of the energy and of every A in each row, as a load case has them; many rows "
      "share the work");
  command.add_flag("--tips", options.files.tips,
                   "Intensity and energy release rate of every tip in each row");
  CLI::Option* output = add_value(command, "-o,--output,--out", options.output, "FILE",
                                  "Result file, HDF5 (default: CASE.h5 in this folder)");
  CLI::Option* csv = add_value(command, "--csv", options.csv, "FILE.csv",
                               "Also write comma-separated text, one line per row");
  command.add_flag("--detach", options.detach, "Submit and return at once")
      ->excludes(output)
      ->excludes(csv);
  add_case_flags(command, options.overrides);
}

}  // namespace

void add_sweep(CLI::App& app, const Globals& globals, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "sweep", "Solve many combinations of a case's loads on one mesh, in one job");
  const auto options = std::make_shared<SweepOptions>();
  add_options(*command, *options);
  command->footer(
      "Row k of the file is the load case c_k1 load_1 + c_k2 load_2 + ..., solved by the active\n"
      "set. The answers are columns: A, energy, contact length, steps, status and contact of\n"
      "every row, with --bounds also bounds of A and the energy, with --tips the intensity and G "
      "of\n"
      "every tip, and traces of the rows you name.\n"
      "Ctrl-C detaches, as in run.\n\n"
      "Example:\n  anticrack sweep load-ratio.toml --coefficients load-ratio.csv\n"
      "  anticrack sweep plate.toml --coefficients runs.h5:/c --traces 0,100-110 --csv runs.csv");
  on(*command, options, globals, chosen, sweep);
}

}  // namespace anticrack::cli
