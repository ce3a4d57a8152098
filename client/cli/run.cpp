// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack run CASE.toml
#include <chrono>
#include <memory>

#include "cli/commands.hpp"
#include "cli/job_run.hpp"

namespace anticrack::cli {
namespace {

struct RunOptions {
  std::string case_file;
  std::string output;
  std::vector<std::string> overrides;
  std::vector<std::string> loads;
};

int run(const RunOptions& options, const Globals& given) {
  const Globals globals = with_outputs(given, {options.output});
  const auto begin = std::chrono::steady_clock::now();
  Session session(globals);
  Case the_case =
      read_case(session, options.case_file, options.overrides, Loads::needed, options.loads);
  if (the_case.spec.priority() == v1::JobSpec::PRIORITY_UNSPECIFIED)
    the_case.spec.set_priority(v1::JobSpec::PRIORITY_INTERACTIVE);  // a user waits for it
  return run_job(session, the_case, result_file(options.case_file, options.output), begin);
}

}  // namespace

void add_run(CLI::App& app, const Globals& globals, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("run", "Mesh, submit, watch and save: the everyday command");
  const auto options = std::make_shared<RunOptions>();
  add_case(*command, options->case_file);
  add_value(*command, "-o,--output", options->output, "FILE",
            "Result file, HDF5 (default: CASE.h5 in this folder)");
  add_case_flags(*command, options->overrides);
  add_load_flag(*command, options->loads);
  command->footer(
      "Ctrl-C detaches and prints the command that attaches again; a second Ctrl-C within two\n"
      "seconds cancels the job and saves what had ended. With --local the first one cancels. "
      "Either\n"
      "exits with 130.\n\n"
      "Example:\n  anticrack --local run paper.toml -o paper.h5\n"
      "  anticrack run plate.toml --set mesh.preset=uniform --set mesh.size=0.02\n"
      "  anticrack run plate.toml --set accuracy.A=1e-3");
  on(*command, options, globals, chosen, run);
}

}  // namespace anticrack::cli
