// SPDX-License-Identifier: GPL-3.0-or-later
//
// Waiting for a mesh, with a word about what the server does meanwhile.
#pragma once

#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "cli/session.hpp"

namespace anticrack::cli {

/// The mesh once the server is done with it, READY, EVICTED or FAILED. On a terminal one line tells
/// state and time and is wiped in the end; elsewhere each state is a line. Throws client::Error,
/// and client::Interrupted on Ctrl-C: the server goes on.
v1::Mesh follow_mesh(Session& session, const std::string& name);

}  // namespace anticrack::cli
