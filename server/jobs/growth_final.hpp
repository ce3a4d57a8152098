// SPDX-License-Identifier: GPL-3.0-or-later
//
// The last part of growth: some of its positions are solved again, each on a mesh of its own that
// is bisected where its bounds come from. Differences of the bounds of Pi bound the mean of G1.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "growth/evolution.hpp"
#include "growth/fronts.hpp"
#include "jobs/engine_core.hpp"

namespace anticrack::jobs {

/// A row of growth, and what it takes to solve it again.
struct GrownState {
  growth::State state;
  double energy = 0;  ///< Pi at t = 1 on the mesh of all positions
};

/// The indices of `count` rows, or of all if there are fewer: the first, the last, and those
/// between at nearly equal lengths of what has come off.
std::vector<std::size_t> final_rows(const std::vector<growth::Row>& rows, std::size_t count);

/// Fills what the rows of `final_positions` have besides, and calls `told` with the index of each,
/// in order; adds notes where something is missing. `states`: one per row. Positions are solved at
/// once on base::Threads, each with one operator in the memory budget at a time; the numbers depend
/// on neither. Throws errors::Error: at "growth.final_positions" that of a position's mesh or load;
/// cancelled.
void add_final(const PreparedCase& prepared, meshes::MeshCatalogue& catalogue,
               const growth::Fronts& fronts, const std::vector<growth::Row>& rows,
               const std::vector<GrownState>& states, contact::Answer& answer,
               const std::function<void(std::size_t)>& told);

}  // namespace anticrack::jobs
