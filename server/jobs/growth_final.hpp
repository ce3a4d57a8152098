// SPDX-License-Identifier: GPL-3.0-or-later
//
// The last part of growth: some of its positions are solved again, each on a mesh of its own that
// is bisected where its bounds come from. Differences of the bounds of Pi bound the mean of G1.
// Several servers solve them together (jobs/spreading.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "fields/fields.hpp"
#include "growth/evolution.hpp"
#include "growth/fronts.hpp"
#include "growth/held.hpp"
#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// A row of growth, and what it takes to solve it again.
struct GrownState {
  growth::State state;
  double energy = 0;  ///< Pi at t = 1 on the mesh of all positions
};

/// What it takes besides the job to solve a position again.
struct PositionRequest {
  growth::State state;
  std::int32_t front = -1;          ///< the one that leaves; -1: none
  std::vector<double> loads;        ///< t of each; without a dead load all are the load case itself
  double aim = 0;                   ///< bounds of Pi as far apart will do
  std::uint64_t max_triangles = 0;  ///< of its meshes
};
ANTICRACK_FIELDS(PositionRequest, state, front, loads, aim, max_triangles)

/// What was found in a position.
struct SolvedPosition {
  std::optional<double> release;        ///< G under the first load of the front that leaves it
  std::string no_release;               ///< why it is missing
  std::string reason;                   ///< why there are no bounds, or no closer ones
  std::vector<growth::Bracket> energy;  ///< of Pi under each load; infinite: no bounds
};
ANTICRACK_FIELDS(SolvedPosition, release, no_release, reason, energy)

/// Solves the position of Task::request. A stop of the job takes effect between two steps. A server
/// that helps fails where its own limits would change the numbers. Throws nothing. Without the
/// lock.
EndedChunk solve_position(const Task& task, meshes::MeshCatalogue& catalogue);

/// The indices of `count` rows, or of all if there are fewer: the first, the last, and those
/// between at nearly equal lengths of what has come off.
std::vector<std::size_t> final_rows(const std::vector<growth::Row>& rows, std::size_t count);

/// Fills what the rows of `final_positions` have besides, and calls `told` with the index of each,
/// in order; adds notes where something is missing. `states`: one per row. Positions are solved at
/// once on base::Threads and by the other servers of a group, each with one operator in the memory
/// budget at a time; the numbers depend on none of these. Throws errors::Error: at
/// "growth.final_positions" that of a position's mesh or load; cancelled.
void add_final(const PreparedCase& prepared, EngineCore& core, const growth::Fronts& fronts,
               const std::vector<growth::Row>& rows, const std::vector<GrownState>& states,
               contact::Answer& answer, const std::function<void(std::size_t)>& told);

}  // namespace anticrack::jobs
