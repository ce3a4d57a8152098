// SPDX-License-Identifier: GPL-3.0-or-later
//
// Jobs of several kinds, what they give when nothing goes wrong, and how two results differ.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "client/block.hpp"
#include "client/connection.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"

namespace anticrack::service_test {

/// A case in two requests.
struct Work {
  std::string name;
  v1::CreateMeshRequest mesh;
  v1::JobSpec spec;             ///< all but the mesh
  std::vector<double> array{};  ///< f of the first load case on the nodes, if any
};

/// A shipped case, "paper-3.toml", with overrides.
Work work(const std::string& name, const std::vector<std::string>& overrides = {});

/// Overrides for exactly this many iterations of Algorithm 2, still on their way at the last one,
/// so that no rounding decides how many there are.
std::vector<std::string> iterations(int count);

/// Several meshes, both methods, short and long ones.
std::vector<Work> mixed_work();

/// Its mesh, its array and its job, under a request id.
v1::Job submit(client::Connection& connection, const Work& work, const std::string& request_id);

/// Waits until a job has ended.
v1::Job wait_for_end(client::Connection& connection, const std::string& name);

/// Whether every load case was solved to its end, converged or (with `iterations`) not.
bool ran_to_its_end(const v1::Job& job);

/// What is in the way of taking `result` for `reference`; empty: nothing. Traces and fields of
/// Algorithm 2 are equal to 1e-12 of their largest value, for the columns beside it change how it
/// rounds; of the active set likewise.
std::string difference(const client::Block& result, const client::Block& reference);

}  // namespace anticrack::service_test
