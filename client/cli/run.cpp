// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack run CASE.toml
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/answers.hpp"
#include "cli/commands.hpp"
#include "cli/exit_codes.hpp"
#include "cli/follow.hpp"
#include "cli/job_text.hpp"
#include "cli/json.hpp"
#include "cli/progress.hpp"
#include "cli/submit.hpp"
#include "cli/text.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "client/uuid.hpp"
#include "results/file.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;

struct RunOptions {
  std::string case_file;
  std::string output;
  std::vector<std::string> overrides;
};

// A server that comes back without its jobs is handed the same job, under the same id, again.
Followed submit_and_follow(Session& session, const casefile::Case& the_case) {
  constexpr int tries = 3;
  const std::string request_id = client::make_uuid();
  for (int attempt = 1;; ++attempt) {
    const v1::Job job = submit(session, the_case, request_id);
    say(session.globals(), job.name() + " on " + job.mesh() + ": " +
                               std::to_string(job.load_cases_size()) +
                               (job.load_cases_size() == 1 ? " load case" : " load cases"));
    try {
      return follow(session, job);
    } catch (const client::Error& error) {
      if (error.code() != client::Code::not_found || attempt == tries) {
        throw;
      }
      say(session.globals(), "The server has lost the job; submitting it again");
    }
  }
}

std::string summary(const results::Result& result, const fs::path& file) {
  const results::Timings& timings = result.timings;
  return "Results: " + file.string() + " (" + std::to_string(result.mesh.triangle_count()) +
         " triangles, " + std::to_string(result.mesh.node_count()) + " nodes; meshing " +
         number(timings.mesh_seconds, 3) + " s, factorising " +
         number(timings.factorize_seconds, 3) + " s, solving " + number(timings.solve_seconds, 3) +
         " s, " + number(timings.total_seconds, 3) + " s in all)";
}

// Why a job came to nothing, line by line.
std::vector<std::string> causes(const v1::Job& job) {
  if (job.state() == v1::Job::STATE_CANCELLED) {
    return {job.name() + " was cancelled"};
  }
  if (job.state() == v1::Job::STATE_EXPIRED) {
    return {expired_text(job)};
  }
  std::vector<std::string> lines;
  if (job.has_error()) {
    lines.push_back(job.name() + " failed: " + job.error().message());
  }
  for (const v1::LoadCaseAnswer& answer : job.answers()) {
    const std::string& cause = answer.error().message();
    const bool told = job.error().message().find(cause) != std::string::npos;
    if (answer.has_error() && !told) {
      lines.push_back(answer.name() + " failed: " + cause);
    }
  }
  if (lines.empty()) {
    lines.push_back(job.name() + " ended without results: " + std::string(word(job.state())));
  }
  return lines;
}

int finish_without_results(const Globals& globals, const v1::Job& job, int exit_code) {
  for (const std::string& line : causes(job)) {
    std::fprintf(stderr, "anticrack: %s\n", sanitise(line).c_str());
  }
  if (globals.json) {
    print_document(to_json(job));
  }
  return exit_code;
}

void save(const fs::path& output, const results::Result& result, const Session& session) {
  try {
    results::write(output, result);
  } catch (const results::Error&) {
    if (!session.globals().local) {
      say(session.globals(),
          "The server still has the results. To fetch them: anticrack job fetch " +
              result.job_name + session.server_option());
    }
    throw;
  }
}

// What an import took for what, or repaired.
void tell_warnings(Session& session, const v1::Job& job) {
  for (const std::string& warning :
       client::get_mesh(session.connection(), job.mesh(), session.stop()).warnings()) {
    say(session.globals(), "mesh: " + warning);
  }
}

int run(const RunOptions& options, const Globals& globals) {
  const auto begin = std::chrono::steady_clock::now();
  casefile::Case the_case = casefile::read_case(options.case_file, options.overrides);
  if (the_case.job.priority() == v1::Job::PRIORITY_UNSPECIFIED) {
    the_case.job.set_priority(v1::Job::PRIORITY_INTERACTIVE);  // somebody waits for it
  }
  const fs::path output = options.output.empty()
                              ? fs::path(options.case_file).filename().replace_extension(".h5")
                              : fs::path(options.output);
  results::check_writable(output);
  Session session(globals);
  if (!the_case.job.title().empty()) {
    say(globals, the_case.job.title());
  }
  const Followed followed = submit_and_follow(session, the_case);
  if (followed.how == Followed::How::detached) {
    if (globals.json) {
      print_document(to_json(followed.job));
    }
    return exit_interrupted;
  }
  tell_warnings(session, followed.job);
  const int job_code = followed.how == Followed::How::cancelled
                           ? exit_interrupted
                           : exit_code_of(followed.job.state());
  if (followed.job.result_bytes() == 0 || followed.job.state() == v1::Job::STATE_EXPIRED) {
    return finish_without_results(globals, followed.job, job_code);
  }
  results::Result result = fetch(session, followed.job);
  result.case_text = the_case.text;
  result.timings.total_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  save(output, result, session);
  if (globals.json) {
    print_document(answers_json(result, output));
  } else {
    print_document("\n" + answers_table(result) + "\n" + sanitise(summary(result, output)));
  }
  return job_code != exit_ok ? job_code : exit_code_of(result);
}

}  // namespace

void add_run(CLI::App& app, const Globals& globals, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("run", "Mesh, submit, watch and save: the everyday command");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("CASE", options->case_file, "The case, a TOML file")->required();
  command->add_option("-o,--output", options->output,
                      "Result file, HDF5 (default: CASE.h5 in this folder)");
  add_case_flags(*command, options->overrides);
  command->footer(
      "Ctrl-C detaches and prints the command that attaches again; a second Ctrl-C within two\n"
      "seconds cancels the job. With --local the first one cancels.\n\n"
      "Example:\n  anticrack --local run client/examples/paper.toml -o paper.h5\n"
      "  anticrack run plate.toml --set mesh.preset=uniform --set mesh.size=0.02");
  command->callback(
      [=, &globals, &chosen] { chosen = [options, &globals] { return run(*options, globals); }; });
}

}  // namespace anticrack::cli
