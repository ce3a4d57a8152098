// SPDX-License-Identifier: GPL-3.0-or-later
//
// Watching a job with a live view, and what Ctrl-C means meanwhile.
#pragma once

#include <cstdint>
#include <string>

#include "anticrack/v1/solve.pb.h"
#include "cli/ahead.hpp"
#include "cli/session.hpp"

namespace anticrack::cli {

struct Followed {
  enum class How { ended, detached, cancelled };  ///< cancelled: by this command, in time
  How how = How::ended;
  v1::Job job;        ///< as it ended; as it was when detached
  AheadFuture ahead;  ///< of submit_and_follow
};

/// Shows a job's progress until it ends. Ctrl-C detaches and says how to attach again; a second one
/// within two seconds cancels the job. With a private server the first one cancels: the server
/// would not outlive the command. `rows`: of a sweep, where the caller knows them: the server does
/// not say before it has the mesh.
Followed follow(Session& session, const v1::Job& job, std::uint64_t rows = 0);

}  // namespace anticrack::cli
