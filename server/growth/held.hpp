// SPDX-License-Identifier: GPL-3.0-or-later
//
// What holds on the paths in a state of the fronts: the mesh on which it is bonded, what comes off
// between two states, and bounds of the mean rate there from those of the energies.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "fields/fields.hpp"
#include "growth/evolution.hpp"
#include "growth/fronts.hpp"
#include "growth/path.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::growth {

/// Nodes of a stretch, first to last: indices into Interface::nodes.
struct Held {
  std::size_t first = 0, last = 0;
};
/// What holds of a stretch; none if all of it has come off.
std::optional<Held> held(const Stretch& stretch, const State& state);

/// The mesh of a state, with the nodes and triangles of `open`: what holds of an inclusion is
/// bonded; what holds of a crack is glue, or, inside a subdomain, no interface, which cuts its
/// chain. O(m log m).
mesh::Mesh mesh_of(const mesh::Mesh& open, const Fronts& fronts, const State& state);

/// What comes off between two states, and bounds of int Gc over it.
struct Opened {
  double length = 0;
  double cost_lower = 0, cost_upper = 0;
};
/// `paths`: one per stretch. The bounds are proved by interval arithmetic on pieces of the edges.
/// Throws errors::Error as find_fronts. O(edges).
Opened opened(const mesh::Mesh& open, const Fronts& fronts, std::span<const Path> paths,
              const State& from, const State& to);

/// Bounds of the exact Pi of a state, at t = 1.
struct Bracket {
  double lower = 0, upper = 0;
};
ANTICRACK_FIELDS(Bracket, lower, upper)

/// Bounds of the mean of G1 over what comes off, (Pi(from) - Pi(to)) / length >= 0, and of the load
/// t at which that energy is what growth costs, t^2 (Pi(from) - Pi(to)) = int Gc. Fronts one after
/// the other: the largest t_c on the way is at least the load, and the least at most.
struct MeanRelease {
  double lower = 0, upper = 0;
  std::optional<double> load_lower, load_upper;  ///< empty: no bound
};
MeanRelease mean_release(const Bracket& from, const Bracket& to, const Opened& between);

}  // namespace anticrack::growth
