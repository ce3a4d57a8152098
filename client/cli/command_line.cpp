// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "cli/commands.hpp"
#include "cli/connection_flags.hpp"
#include "cli/programs.hpp"
#include "cli/report.hpp"
#include "guide/guide.hpp"
#include "output/standard.hpp"

namespace anticrack::cli {
namespace {

constexpr const char* footer =
    "Exit codes:\n"
    "  0    all load cases converged\n"
    "  1    a job failed\n"
    "  2    usage or case file wrong, or output that cannot be written\n"
    "  3    some load case did not converge; its results are saved all the same\n"
    "  4    server unreachable or refusing\n"
    "  130  interrupted: detached from the job, or cancelled it\n"
    "  141  standard output was closed, as by | head; results are saved all the same\n\n"
    "Other commands:\n"
    "  anticrack NAME runs the program anticrack-NAME, if there is one beside anticrack or on "
    "PATH\n\n"
    "Cases to begin with:\n"
    "  client/examples in the sources, /usr/share/anticrack/examples in the Debian package\n\n"
    "Example:\n  anticrack --local run paper.toml";

// The exit code of a command that has ended; another one if standard output did not take its text.
int checked_output(int code) {
  const int error = output::print_failure();
  if (error == 0) return code;
  if (error == EPIPE) return code == exit_ok ? exit_closed : code;
  complain("standard output cannot be written: " + std::generic_category().message(error));
  return code == exit_ok ? exit_usage : code;
}

// The first word that is neither an option nor its value.
std::vector<std::string>::iterator first_command(const CLI::App& app,
                                                 std::vector<std::string>& words) {
  auto word = words.begin();
  for (; word != words.end() && word->starts_with('-'); ++word) {
    const CLI::Option* option = app.get_option_no_throw(*word);
    const bool has_value = option != nullptr && option->get_items_expected() > 0;
    if (has_value && word + 1 != words.end()) ++word;
  }
  return word;
}

int parse_and_run(int argc, char** argv) {
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
               "Nothing but errors and what is asked for as output, such as the name of a new job");
  app.footer(footer);
  add_run(app, globals, chosen);
  add_sweep(app, globals, chosen);
  add_mesh(app, globals, chosen);
  add_job(app, globals, chosen);
  add_show(app, globals, chosen);
  std::vector<std::string> words(argv + 1, argv + argc);
  auto command_at = first_command(app, words);
  const std::string name = command_at == words.end() ? "" : *command_at;
  std::vector<std::string> others = words;  // options before the name are the command's own
  if (!name.empty()) others.erase(others.begin() + (command_at - words.begin()));
  add_programs(app, globals, others, chosen);
  add_server(app, globals, chosen);
  add_explain(app, globals, chosen);
  add_guide(app, globals, chosen);
  if (argc > 1 && std::string_view(argv[1]) == "--complete") {
    print_document(guide::completions(app, {argv + 2, argv + argc}, [&] {
      app.parse("server");  // so that the environment sets the flags
      return case_keys(globals.connection);
    }));
    return exit_ok;
  }
  const auto has_name = [&](const CLI::App* command) { return command->get_name() == name; };
  if (name == "plot" || app.get_subcommands(has_name).empty()) {
    if (const auto program = external_command(name); !program.empty()) {
      others.insert(others.begin(), program.string());
      return guarded(globals, [&]() -> int { become(others); });
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    std::ostringstream text;
    const int code = app.exit(success, text, text);
    print_document(text.str());
    return code;
  } catch (const CLI::ParseError& error) {
    // Looked up here, as the parser may have stopped before it read --json.
    globals.json = std::find(words.begin(), words.end(), "--json") != words.end();
    const std::string problem = usage_text(app, error, words);
    return guarded(globals, [&problem]() -> int { throw UsageError(problem); });
  }
  if (globals.local) globals.connection = {};  // the server of the environment is not meant
  return guarded(globals, chosen);
}

}  // namespace

int run_command_line(int argc, char** argv) { return checked_output(parse_and_run(argc, argv)); }

}  // namespace anticrack::cli
