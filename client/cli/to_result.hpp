// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes a result from the server's messages. Pure.
#pragma once

#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/server.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "client/block.hpp"
#include "results/result.hpp"

namespace anticrack::cli {

struct Fetched {
  v1::Job job;
  v1::Mesh mesh;
  v1::ServerInfo server;
  client::Block mesh_block;
  client::Block result_block;
};

/// The name of the mesh to which the answers of a job belong: that of its last stage with answers.
std::string mesh_of(const v1::Job& job);

/// The result. Throws results::Error for parts that do not fit together.
results::Result to_result(Fetched fetched);

/// The answers so far, without traces, fields and histories: one per load case.
std::vector<results::Load> to_loads(const v1::Job& job);

}  // namespace anticrack::cli
