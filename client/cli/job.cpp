// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack job submit | list | show | watch | cancel | fetch | delete
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "cli/commands.hpp"
#include "cli/job_run.hpp"
#include "cli/json.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/resource_names.hpp"
#include "cli/submit.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"
#include "cli/to_result.hpp"
#include "client/jobs.hpp"
#include "output/file.hpp"
#include "results/file.hpp"

namespace anticrack::cli {
namespace {

struct JobOptions {
  std::string case_file;
  std::vector<std::string> overrides;
  std::vector<std::string> loads;
  std::string name;
  std::string output;
  int limit = 50;
  std::string owner;
  std::vector<std::string> states;
  std::string mesh;
  bool oldest_first = false;
  bool fields = false;
};

void print_job(const Globals& globals, const v1::Job& job) {
  print_document(globals.json ? to_json(job) : job_text(job));
}

bool prints_outcome(const Globals& globals) { return globals.json || !globals.quiet; }

int submit_case(const JobOptions& options, const Globals& globals) {
  Session session(globals);
  const Case the_case =
      read_case(session, options.case_file, options.overrides, Loads::needed, options.loads);
  const v1::Job job = submit(session, the_case, client::make_uuid());
  tell_submitted(session, job);
  return exit_ok;
}

const std::map<std::string, v1::JobStatus::State> states{
    {"queued", v1::JobStatus::STATE_QUEUED},
    {"waiting", v1::JobStatus::STATE_WAITING_FOR_MESH},
    {"running", v1::JobStatus::STATE_RUNNING},
    {"done", v1::JobStatus::STATE_SUCCEEDED},
    {"not-converged", v1::JobStatus::STATE_NOT_CONVERGED},
    {"failed", v1::JobStatus::STATE_FAILED},
    {"cancelled", v1::JobStatus::STATE_CANCELLED},
};

// The number of load cases, or rows of a sweep, that have ended, like "3/4".
std::string ended_text(const v1::Job& job) {
  if (job.spec().has_sweep()) {
    const v1::SweepAnswer& sweep = job.status().sweep_answer();
    return fmt::format("{}/{} rows", sweep.converged() + sweep.not_converged() + sweep.failed(),
                       sweep.rows());
  }
  return fmt::format("{}/{}", job.status().load_cases_ended(), job.status().load_case_count());
}

int list_jobs(const JobOptions& options, const Globals& globals) {
  Session session(globals);
  v1::ListJobsRequest request;
  request.set_page_size(options.limit);
  request.set_owner(options.owner);
  for (const std::string& state : options.states) request.add_states(states.at(state));
  if (!options.mesh.empty()) request.set_mesh(full_name(Collection::meshes, options.mesh));
  request.set_oldest_first(options.oldest_first);
  v1::ListJobsResponse response = client::list_jobs(session.connection(), request, session.stop());
  // A page may have fewer jobs than wanted. MergeFrom keeps the token if the new one is empty.
  while (response.jobs_size() < options.limit && !response.next_page_token().empty()) {
    request.set_page_size(options.limit - response.jobs_size());
    request.set_page_token(response.next_page_token());
    response.MergeFrom(client::list_jobs(session.connection(), request, session.stop()));
    if (response.next_page_token() == request.page_token()) response.clear_next_page_token();
  }
  if (globals.json) {
    print_document(to_json(response));
    return exit_ok;
  }
  std::vector<std::vector<std::string>> rows{
      {"job", "created", "state", "cases ended", "mesh", "owner", "title"}};
  for (const v1::Job& job : response.jobs()) {
    rows.push_back({job.name(), clock_text(job.status().create_time().seconds()),
                    std::string(word(job.status().state())), ended_text(job), job.spec().mesh(),
                    job.owner(), job.spec().title()});
  }
  drop_if_empty(rows, 5);  // without users there are no owners
  print_document(table(rows, {1, 2, 4, 5, 6}));
  if (!response.next_page_token().empty()) say(globals, "There are more; see --limit");
  return exit_ok;
}

v1::Job get_job(Session& session, const JobOptions& options) {
  return call_about(session, Collection::jobs, options.name, client::get_job);
}

int show(const JobOptions& options, const Globals& globals) {
  Session session(globals);
  print_job(globals, get_job(session, options));
  return exit_ok;
}

int cancel(const JobOptions& options, const Globals& globals) {
  Session session(globals);
  const v1::Job job = call_about(session, Collection::jobs, options.name, client::cancel_job);
  if (prints_outcome(globals)) print_job(globals, job);
  return exit_ok;
}

int remove(const JobOptions& options, const Globals& globals) {
  Session session(globals);
  call_about(session, Collection::jobs, options.name, client::delete_job);
  tell_deleted(globals, full_name(Collection::jobs, options.name));
  return exit_ok;
}

int watch_job(const JobOptions& options, const Globals& globals) {
  Session session(globals);
  session.signals().end_on_closed_output();
  const Followed followed = follow(session, get_job(session, options));
  const int code = code_of(globals, followed);
  if (followed.how == Followed::How::detached) return code;
  if (prints_outcome(globals))
    print_job(globals, followed.job);
  else
    complain_of(followed.job);
  return code;
}

// A job that solves the load cases of another one again, with fields, on the same mesh.
v1::JobSpec with_fields(const v1::Job& job) {
  v1::JobSpec again = job.spec();
  again.set_mesh(mesh_of(job));
  again.clear_task();  // that is the mesh of the last stage
  again.add_outputs(v1::OUTPUT_FIELDS);
  again.set_priority(v1::JobSpec::PRIORITY_INTERACTIVE);
  return again;
}

bool has_fields(const v1::Job& job) {
  return std::ranges::find(job.spec().outputs(), v1::OUTPUT_FIELDS) != job.spec().outputs().end();
}

// Solves a job that has ended without fields anew, with fields.
Followed solve_with_fields(Session& session, const v1::Job& job) {
  if (job.spec().has_sweep()) {
    throw UsageError(job.name() +
                     " is a sweep, which has no fields; run a case of the load you want to see");
  }
  const v1::Job again = client::create_job(session.connection(), with_fields(job),
                                           client::make_uuid(), session.stop());
  say(session.globals(), job.name() + " has no fields; " + again.name() + " solves it again");
  return follow(session, again);
}

int fetch_result(const JobOptions& options, const Globals& given) {
  const Globals globals = with_outputs(given, {options.output});
  const std::string name = full_name(Collection::jobs, options.name);
  const std::string output =
      options.output.empty() ? name.substr(std::string("jobs/").size()) + ".h5" : options.output;
  output::check_writable(output);
  Session session(globals);
  v1::Job job = get_job(session, options);
  if (options.fields && client::ended(job.status().state()) && !has_fields(job)) {
    Followed followed = solve_with_fields(session, job);
    if (followed.how == Followed::How::detached) return exit_interrupted;
    job = std::move(followed.job);
  }
  if (job.status().result_state() == v1::JobStatus::RESULT_STATE_EXPIRED)
    throw client::Error(client::Code::failed_precondition, expired_text(job));
  const results::Result result = fetch(session, job, session.stop());
  const std::string kept = results::write(output, result);
  if (!kept.empty()) say(globals, kept);
  if (globals.json)
    print_document(answers_json(result, output));
  else if (globals.quiet)
    complain_of(job);
  else
    print_answer(globals,
                 answers_table(result) + accuracy_text(job) + "\nResults: " + sanitise(output));
  return exit_code_of(job);
}

}  // namespace

void add_job(CLI::App& app, const Globals& globals, Command& chosen) {
  CLI::App* group = app.add_subcommand("job", "Jobs on the server");
  group->require_subcommand(1);
  const auto options = std::make_shared<JobOptions>();
  const auto add = [&](const std::string& name, const std::string& help, const std::string& example,
                       int (*action)(const JobOptions&, const Globals&)) {
    CLI::App* command = group->add_subcommand(name, help);
    command->footer("Example:\n  anticrack job " + name + " " + example);
    on(*command, options, globals, chosen, action);
    return command;
  };
  const auto add_named = [&](const std::string& name, const std::string& help,
                             const std::string& example,
                             int (*action)(const JobOptions&, const Globals&)) {
    CLI::App* command = add(name, help, "jobs/0123456789abcdef" + example, action);
    command->add_option("JOB", options->name, "jobs/ID")->required();
    return command;
  };
  CLI::App* submit_command =
      add("submit", "Submit a case and return at once", "paper.toml", submit_case);
  add_case(*submit_command, options->case_file);
  add_case_flags(*submit_command, options->overrides);
  add_load_flag(*submit_command, options->loads);
  CLI::App* list = add("list", "List jobs", "--state running", list_jobs);
  add_list_flags(*list, "jobs", options->limit, options->owner);
  list->add_option("--state", options->states, "Only jobs in this state; again for more")
      ->check(CLI::IsMember(states))
      ->allow_extra_args(false);
  add_value(*list, "--mesh", options->mesh, "meshes/ID", "Only jobs on this mesh");
  list->add_flag("--oldest-first", options->oldest_first, "The oldest job first, not the newest");
  add_named("show", "Show a job", "", show);
  add_named("watch", "Watch a job until it ends", "", watch_job)
      ->footer(
          "Ctrl-C detaches and prints the command that attaches again; a second Ctrl-C within two\n"
          "seconds cancels the job. The exit code is then 130.\n\n"
          "Example:\n  anticrack job watch jobs/0123456789abcdef");
  add_named("cancel", "Cancel a job", "", cancel);
  CLI::App* fetch =
      add_named("fetch", "Save the results of a job that has ended", " -o plate.h5", fetch_result);
  add_value(*fetch, "-o,--output", options->output, "FILE",
            "Result file, HDF5 (default: ID.h5 in this folder)");
  fetch->add_flag("--fields", options->fields,
                  "With u on every node; where the job has it not, it is solved again");
  add_named("delete", "Delete a job that has ended, and its results", "", remove);
}

}  // namespace anticrack::cli
