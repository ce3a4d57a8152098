// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a result file needs besides the answers, fetched and compressed while the job is solved.
#pragma once

#include <future>
#include <memory>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/server.pb.h"
#include "cli/session.hpp"
#include "client/block.hpp"
#include "results/compressed_mesh.hpp"

namespace anticrack::cli {

/// The mesh of a job.
struct Ahead {
  v1::Mesh mesh;
  v1::ServerInfo server;
  client::Block mesh_block;
  results::CompressedMesh compressed;
};

/// Null where the mesh was not READY yet or something failed: then all is fetched in the end, and
/// what is wrong is told then.
using AheadFuture = std::shared_future<std::shared_ptr<Ahead>>;

/// Begins on a thread of its own. The session must outlive the future.
AheadFuture fetch_ahead(Session& session, const std::string& mesh);

}  // namespace anticrack::cli
