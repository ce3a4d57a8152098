// SPDX-License-Identifier: GPL-3.0-or-later
//
// A case on its way to the server, and answers on their way back.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/server.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "cli/case.hpp"
#include "cli/session.hpp"
#include "client/block.hpp"
#include "results/file.hpp"

namespace CLI {
class App;
}

namespace anticrack::cli {

/// --set, and the flags of what stands in [job], which are overrides as well. For commands that
/// submit a case.
void add_case_flags(CLI::App& command, std::vector<std::string>& overrides);

/// --load: only these load cases of the case.
void add_load_flag(CLI::App& command, std::vector<std::string>& loads);

/// The server names fields of a request; the user knows lines of a file.
client::Error in_terms_of(const Case& the_case, const client::Error& error);

/// Does what the server may refuse; its error is then in terms of the case.
template <class Call>
auto translated(const Case& the_case, const Call& call) -> decltype(call()) {
  try {
    return call();
  } catch (const client::Error& error) {
    throw in_terms_of(the_case, error);
  }
}

/// Uploads the case's .msh if it has one, and creates its mesh. A refusal names the lines of the
/// case it is about; else what the case notes is told.
v1::Mesh create_mesh(Session& session, const Case& the_case);

/// Completes a job before it is submitted: what it needs besides the case has to be uploaded first,
/// and again for a server that has lost it.
using Prepare = std::function<void(v1::JobSpec&)>;

/// create_mesh, then the job. Repeating it with the same id is harmless.
v1::Job submit(Session& session, const Case& the_case, const std::string& request_id,
               const Prepare& prepare = {});

/// What a command that submits and does not wait says.
void tell_submitted(const Session& session, const v1::Job& job);

/// What a result file needs besides the answers: fetched while the job is solved.
struct Ahead {
  v1::Mesh mesh;
  v1::ServerInfo server;
  client::Block mesh_block;
};

/// Null if the mesh was not READY yet or something failed. Everything is then fetched at the end,
/// which also reports what is wrong.
using AheadFuture = std::shared_future<std::shared_ptr<Ahead>>;

/// Begins on a thread of its own; null for a job in stages, which ends on another mesh. The session
/// must outlive the future.
AheadFuture fetch_ahead(Session& session, const v1::Job& job);

/// Everything about a job that has ended and has results. `ahead`: what of it is here already, its
/// block is taken; may be null.
results::Result fetch(Session& session, const v1::Job& job, const std::stop_token& stop,
                      Ahead* ahead = nullptr);

/// Of a job that has ended: exit_ok, exit_not_converged, or exit_job_failed if it or one of its
/// load cases failed or was cancelled.
int exit_code_of(const v1::Job& job);

/// Prints as errors what did not go as it was asked for: with --quiet this is all that is told.
void complain_of(const v1::Job& job);
/// Only why it could not be run to its end, where it left answers: those of its last whole stage.
void complain_of_failure(const v1::Job& job);

}  // namespace anticrack::cli
