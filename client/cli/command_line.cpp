// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "casefile/nearest.hpp"
#include "cli/commands.hpp"
#include "cli/connection_flags.hpp"
#include "cli/exit_codes.hpp"
#include "cli/report.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

constexpr const char* footer =
    "Exit codes:\n"
    "  0    all load cases converged\n"
    "  1    a job failed\n"
    "  2    usage or case file wrong\n"
    "  3    some load case did not converge; its results are saved all the same\n"
    "  4    server unreachable or refusing\n"
    "  130  interrupted: detached from the job, or cancelled it\n\n"
    "Example:\n  anticrack --local run client/examples/paper.toml";

// CLI11 only says that a command is missing; say which word is none, and what it may have meant.
std::string unknown_command(CLI::App& app, int argc, char** argv) {
  CLI::App* level = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind('-', 0) == 0) {
      const CLI::Option* option = app.get_option_no_throw(word);
      i += option != nullptr && option->get_items_expected_max() > 0 ? 1 : 0;
      continue;
    }
    std::vector<std::string> commands;
    for (const CLI::App* command : level->get_subcommands({})) {
      if (!command->get_name().empty()) {  // else it is a group of options
        commands.push_back(command->get_name());
      }
    }
    if (commands.empty()) {
      break;
    }
    if (std::find(commands.begin(), commands.end(), word) == commands.end()) {
      return "unknown command " + word + "; " + casefile::suggestion(word, commands);
    }
    level = level->get_subcommand(word);
  }
  return "";
}

}  // namespace

int run_command_line(int argc, char** argv) {
  Globals globals;
  Command chosen;
  CLI::App app("Solves elastic membranes with cracks and delaminated thin rigid inclusions.",
               "anticrack");
  app.require_subcommand(1);
  app.fallthrough();  // --json and the others may also stand behind the command
  app.set_version_flag("-v,--version", "anticrack " ANTICRACK_VERSION);
  add_connection_flags(app, globals.connection);
  app.add_flag(
      "--local", globals.local,
      "Start a private anticrackd for this one command and stop it after; goes before --server");
  app.add_flag("--json", globals.json,
               "One JSON document on standard output, everything else on standard error");
  app.add_flag("--quiet", globals.quiet,
               "Plain lines instead of the live view of a job; the same as NO_COLOR=1");
  app.footer(footer);
  add_run(app, globals, chosen);
  add_sweep(app, globals, chosen);
  add_mesh(app, globals, chosen);
  add_job(app, globals, chosen);
  add_files(app, globals, chosen);
  add_server(app, globals, chosen);
  add_guide(app, globals, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_command(app, argc, argv);
    if (unknown.empty()) {
      app.exit(error, std::cerr, std::cerr);
    } else {
      std::cerr << "anticrack: " << sanitise(unknown) << '\n';
    }
    return exit_usage;
  }
  if (globals.local) {
    globals.connection = {};  // what the environment names is not meant
  }
  return guarded(globals, chosen);
}

}  // namespace anticrack::cli
