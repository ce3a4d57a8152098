// SPDX-License-Identifier: GPL-3.0-or-later
//
// Point forces and forces on inclusions as forces on nodes.
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

/// Distance, as a fraction of the diagonal of the membrane's bounding box, within which a point
/// lies on an edge or inside the membrane.
constexpr double point_tolerance = 1e-9;

/// A point force on an edge of an inclusion, bonded or delaminated, acts on the inclusion;
/// elsewhere on the corners of the triangle that contains it, by barycentric coordinates (int delta
/// phi_i). A force on an inclusion acts on one trace node of it, since all share its displacement.
/// Throws errors::Error (invalid_argument): "point_forces[I].at" for a point outside the membrane
/// or on a crack without inclusion, "inclusion_forces[NAME]" for an unknown inclusion. O(m log k +
/// hits) for k points.
PlacedForces place_forces(const fem::Load& load, const mesh::Mesh& mesh,
                          const ddm::Decomposition& decomposition);

}  // namespace anticrack::operators
