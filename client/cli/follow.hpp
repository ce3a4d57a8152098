// SPDX-License-Identifier: GPL-3.0-or-later
//
// Follows a job or a mesh with a live view, and handles Ctrl-C meanwhile.
#pragma once

#include <cstdint>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "cli/session.hpp"
#include "cli/submit.hpp"

namespace anticrack::cli {

struct Followed {
  enum class How { ended, detached, cancelled };  ///< cancelled: by this command, in time
  How how = How::ended;
  v1::Job job;        ///< as it ended, or as it was when detached
  AheadFuture ahead;  ///< set by run_job
};

/// Shows a job's progress until it ends. Ctrl-C detaches and says how to attach again; a second one
/// within two seconds cancels the job. With a private server the first Ctrl-C cancels, as the
/// server would not outlive the command. `rows`: those of a sweep, if the caller knows them, since
/// the server does not tell before it has the mesh.
Followed follow(Session& session, const v1::Job& job, std::uint64_t rows = 0);

/// Waits until the server is done with a mesh, and returns it: READY, EVICTED or FAILED. On a
/// terminal one line shows state and time and is wiped at the end; elsewhere each state is a line.
/// Throws client::Error, and client::Interrupted on Ctrl-C, after which the server goes on.
v1::Mesh follow_mesh(Session& session, const std::string& name);

}  // namespace anticrack::cli
