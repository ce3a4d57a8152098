// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sends a case to the server, and fetches its answers.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "cli/case.hpp"
#include "cli/session.hpp"
#include "cli/to_result.hpp"
#include "results/file.hpp"

namespace CLI {
class App;
}

namespace anticrack::cli {

/// Adds --set, and flags for the keys of [job], which are overrides as well. For commands that
/// submit a case.
void add_case_flags(CLI::App& command, std::vector<std::string>& overrides);

/// Adds --load, which selects load cases of the case.
void add_load_flag(CLI::App& command, std::vector<std::string>& loads);

/// The error with lines of the case, which the user knows, instead of fields of a request.
client::Error in_terms_of(const Case& the_case, const client::Error& error);

/// Runs a call that the server may refuse; its error is then in terms of the case.
template <class Call>
auto translated(const Case& the_case, const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const client::Error& error) {
    throw in_terms_of(the_case, error);
  }
}

/// Uploads the case's .msh, if it has one, and creates its mesh. A refusal names the lines of the
/// case at fault; otherwise the notes of the case are told.
v1::Mesh create_mesh(Session& session, const Case& the_case);

/// Completes a job before it is submitted: data that it needs besides the case must be uploaded
/// first, and again for a server that has lost them.
using Prepare = std::function<void(v1::JobSpec&)>;

/// Creates the mesh, then the job. Repeating it with the same id is harmless.
v1::Job submit(Session& session, const Case& the_case, const std::string& request_id,
               const Prepare& prepare = {});

/// The message of a command that submits and does not wait.
void tell_submitted(const Session& session, const v1::Job& job);

/// What a result needs besides the job and its answers, fetched as soon as the mesh has triangles.
/// Null if it had none before the job ended or something failed: then everything is fetched at the
/// end, which also reports errors.
using AheadFuture = std::shared_future<std::shared_ptr<Fetched>>;

/// Begins to fetch on another thread, which waits for the mesh until `end`; null for a job in
/// stages, which ends on another mesh. The session must outlive the future.
AheadFuture fetch_ahead(Session& session, const v1::Job& job, const std::stop_token& end);

/// Fetches everything about a job that has ended and has results. `ahead`: the data that are here
/// already, which are taken; may be null.
results::Result fetch(Session& session, const v1::Job& job, const std::stop_token& stop,
                      Fetched* ahead = nullptr);

/// The exit code for a job that has ended: exit_ok, exit_not_converged, or exit_job_failed if it or
/// one of its load cases failed or was cancelled.
int exit_code_of(const v1::Job& job);

/// Prints the shortfalls of a job as errors; with --quiet nothing else is told.
void complain_of(const v1::Job& job);
/// Prints only why a job could not run to its end though it has answers, which are those of its
/// last complete stage.
void complain_of_failure(const v1::Job& job);

}  // namespace anticrack::cli
