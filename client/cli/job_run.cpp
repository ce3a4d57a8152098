// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/job_run.hpp"

#include <fmt/core.h>

#include <optional>
#include <vector>

#include "cli/json.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "output/file.hpp"
#include "results/file.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;

std::string counted_cases(const v1::JobSpec& spec, std::uint64_t rows) {
  if (spec.has_sweep()) return "a sweep of " + counted(rows, "row");
  return counted(static_cast<std::size_t>(spec.load_cases_size()), "load case");
}

std::string summary(const results::Result& result, const fs::path& file) {
  const v1::Mesh& mesh = result.mesh;
  return fmt::format(
      "Results: {} ({} triangles, {} nodes; meshing {} s, factorising {} s, solving {} s, {} s in "
      "all)",
      file.string(), mesh.triangle_count(), mesh.node_count(), seconds(mesh.mesh_seconds()),
      seconds(mesh.factorize_seconds()), seconds(results::solve_seconds(result)),
      seconds(result.total_seconds));
}

// The reasons why a job has no answers, line by line, in terms of its case.
std::vector<std::string> causes(const Case& the_case, const v1::Job& job) {
  if (job.status().result_state() == v1::JobStatus::RESULT_STATE_EXPIRED)
    return {expired_text(job)};
  std::vector<std::string> lines = shortfalls(job, [&the_case](const v1::Status& error) {
    return std::string(in_terms_of(the_case, client::decode_error(error)).what());
  });
  if (lines.empty())
    lines.push_back(job.name() +
                    " ended without results: " + std::string(word(job.status().state())));
  return lines;
}

// Prints the warnings of an import: what it assumed, or repaired.
void tell_warnings(Session& session, const v1::Job& job, const std::stop_token& stop,
                   const Fetched* ahead) {
  const v1::Mesh mesh = ahead != nullptr
                            ? ahead->mesh
                            : client::get_mesh(session.connection(), job.spec().mesh(), stop);
  for (const std::string& warning : mesh.warnings()) say(session.globals(), "mesh: " + warning);
}

// Says how to fetch results that the server has but the user has not.
void tell_fetch(const Session& session, const std::string& job) {
  if (!session.globals().local) {
    say_always(session.globals(),
               "The server still has the results. To fetch them: anticrack job fetch " + job +
                   session.server_option());
  }
}

// Runs `action`; if the user interrupts it, says how to get the results later.
template <class Action>
auto or_later(const Session& session, const v1::Job& job, const Action& action) {
  try {
    return action();
  } catch (const client::Interrupted&) {
    if (job.status().result_bytes() > 0) tell_fetch(session, job.name());
    throw;
  }
}

struct EndOfWait {
  std::stop_source& of;
  ~EndOfWait() { of.request_stop(); }
};

// Submits a case and shows its progress. If the server comes back without its jobs, the same job is
// submitted again under the same id.
Followed submit_and_follow(Session& session, const Case& the_case, const Prepare& prepare,
                           std::uint64_t rows) {
  constexpr int tries = 3;
  const std::string request_id = client::make_uuid();
  for (int attempt = 1;; ++attempt) {
    const v1::Job job = submit(session, the_case, request_id, prepare);
    say(session.globals(),
        job.name() + " on " + job.spec().mesh() + ": " + counted_cases(job.spec(), rows));
    std::stop_source end;
    const AheadFuture ahead = fetch_ahead(session, job, end.get_token());
    const EndOfWait ends{end};
    try {
      Followed followed = follow(session, job, rows);
      followed.ahead = ahead;
      return followed;
    } catch (const client::Error& error) {
      if (error.code() != client::Code::not_found || attempt == tries) throw;
      say(session.globals(), "The server has lost the job; submitting it again");
    }
  }
}

// With the text of the case and the time since `begin`. Empty if the job has no results; then the
// user is told why.
std::optional<results::Result> results_of(Session& session, const Case& the_case,
                                          const Followed& followed,
                                          std::chrono::steady_clock::time_point begin) {
  const v1::Job& job = followed.job;
  // The signal that cancelled the job must not prevent saving what it had solved.
  const std::stop_token stop =
      followed.how == Followed::How::cancelled ? std::stop_token() : session.stop();
  Fetched* const ahead = followed.ahead.get().get();
  or_later(session, job, [&] { tell_warnings(session, job, stop, ahead); });
  if (job.status().result_bytes() == 0) {
    for (const std::string& line : causes(the_case, job)) complain(line);
    if (session.globals().json) print_document(to_json(job));
    return std::nullopt;
  }
  results::Result result = or_later(session, job, [&] { return fetch(session, job, stop, ahead); });
  result.case_text = the_case.text;
  result.total_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

void save(const fs::path& file, const results::Result& result, const Session& session) {
  try {
    const std::string kept = results::write(file, result);
    if (!kept.empty()) say(session.globals(), kept);
  } catch (const results::Error&) {
    tell_fetch(session, result.job_name);
    throw;
  }
}

// With --quiet only what is wrong with them.
void print_answers(const Globals& globals, const v1::Job& job, const results::Result& result,
                   const fs::path& file) {
  if (globals.quiet && !globals.json) return complain_of(job);
  complain_of_failure(job);
  if (globals.json)
    print_document(answers_json(result, file));
  else
    print_answer(globals, "\n" + answers_table(result) + accuracy_text(job) + "\n" +
                              sanitise(summary(result, file)));
}

}  // namespace

fs::path result_file(const std::string& case_file, const std::string& output) {
  fs::path file =
      output.empty() ? fs::path(case_file).filename().replace_extension(".h5") : fs::path(output);
  std::error_code none;  // a missing file is no error
  if (fs::equivalent(file, case_file, none))
    throw results::Error(file.string(), "is the case itself", "name another file for the results");
  output::check_writable(file);
  return file;
}

fs::path csv_file(const std::string& csv, const fs::path& result_file) {
  if (csv.empty()) return {};
  output::check_writable(csv);
  const output::Target target = output::target_of(csv);
  if (target.kind == output::Target::Kind::file &&
      fs::weakly_canonical(target.path) ==
          fs::weakly_canonical(output::target_of(result_file).path)) {
    throw CaseError("--csv " + csv, "this is also the result file; name another one");
  }
  return csv;
}

int code_of(const Globals& globals, const Followed& followed) {
  if (followed.how == Followed::How::ended) return exit_code_of(followed.job);
  if (followed.how == Followed::How::detached && globals.json)
    print_document(to_json(followed.job));
  return exit_interrupted;
}

int run_job(Session& session, const Case& the_case, const fs::path& output,
            std::chrono::steady_clock::time_point begin, const OfSweep& more) {
  const Globals& globals = session.globals();
  if (!the_case.spec.title().empty()) say(globals, the_case.spec.title());
  const Followed followed = submit_and_follow(session, the_case, more.prepare, more.rows);
  const int code = code_of(globals, followed);
  if (followed.how == Followed::How::detached) return code;
  std::optional<results::Result> result = results_of(session, the_case, followed, begin);
  if (!result) return code;
  session.leave_server();
  if (more.complete) more.complete(*result);
  save(output, *result, session);
  if (more.saved) more.saved(*result);
  print_answers(globals, followed.job, *result, output);
  return code;
}

}  // namespace anticrack::cli
