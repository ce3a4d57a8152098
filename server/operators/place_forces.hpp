// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where forces that act in a point or on an inclusion enter the load.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ddm/decomposition.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::operators {

/// Added to the load of one node of a subdomain.
struct NodalForce {
  std::int32_t node = 0;  ///< in the subdomain's numbering
  double value = 0;
};

struct PlacedForces {
  std::vector<std::vector<NodalForce>> subdomains;  ///< one list per subdomain
  std::vector<double> inclusions;                   ///< force on each of Mesh::inclusions
};

/// A point counts as on an edge, and as inside the membrane, when it is no farther from it than
/// this part of the diagonal of the membrane's bounding box.
constexpr double point_tolerance = 1e-9;

/// A point force on an edge of an inclusion, bonded or delaminated, acts on the inclusion; one
/// elsewhere on the corners of the triangle that holds the point, by its barycentric coordinates
/// (int delta phi_i). On glue both sides do. A force on an inclusion acts on one trace node
/// that the inclusion holds: all of them share its displacement.
/// Throws errors::Error (invalid_argument): "point_forces[I].at" for a point outside the membrane
/// or on a crack without inclusion, whose two sides move apart; "inclusion_forces[NAME]" for an
/// inclusion that the mesh does not have, with those it has. O(m log k + hits), k points.
PlacedForces place_forces(const fem::Load& load, const mesh::Mesh& mesh,
                          const ddm::Decomposition& decomposition);

}  // namespace anticrack::operators
