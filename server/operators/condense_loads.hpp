// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "contact/solve.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/neumann_boundary.hpp"
#include "ddm/subdomain_operator.hpp"
#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "fem/load_parts.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::operators {

/// The load on each triangle and Neumann edge, for bounds of the error.
struct LoadParts {
  fem::Force force;
  std::vector<fem::ForceParts> integrated;   ///< per subdomain; empty: from fem::linear_load
  std::vector<fem::TractionParts> traction;  ///< per subdomain; empty: no traction
  std::string boundary_value;                ///< g_D; empty: linear along edges
  std::string beside_chords;                 ///< g_D, whatever it is
  std::string obstacle;                      ///< why there are no bounds, with the cure
  std::vector<mesh::Point> points;           ///< where forces act on the membrane itself
};

/// A load case condensed to the traces.
struct LoadOnTraces {
  std::vector<ddm::CondensedLoad> subdomains;  ///< one per subdomain
  /// Total force on each of Mesh::inclusions, point forces included; on_nodes is in `g` of
  /// `subdomains`.
  std::vector<contact::InclusionForce> inclusion_forces;
  /// Integrals that reached a limit, with their error bound; PlacedForces::warnings.
  std::vector<std::string> warnings;
  LoadParts parts;  ///< only if asked for
};

/// (subdomain, int f phi_i of all its nodes, g_D in its Dirichlet nodes); each column is a load.
using Condense = std::function<std::vector<ddm::CondensedLoad>(
    std::size_t, const Eigen::Ref<const Eigen::MatrixXd>&,
    const Eigen::Ref<const Eigen::MatrixXd>&)>;

using CondensedOutcome = std::variant<LoadOnTraces, errors::Error>;

/// Integrates all loads on the membrane (paper: f, g_D; tractions, point forces, forces on
/// inclusions) and condenses them to the traces by one forward solve per subdomain and load, two if
/// g_D is not zero, in blocks of loads. Entry i holds the result or error of loads[i]:
/// invalid_argument (unknown subdomain or inclusion, array of another length, point force outside
/// or on a crack, overflow), expression_invalid, or cancelled (stop/stop.hpp). `parts`: whether to
/// fill LoadOnTraces::parts. Subdomains are done on base::Threads.
std::vector<CondensedOutcome> condense_loads(std::span<const fem::Load* const> loads,
                                             const mesh::Mesh& mesh,
                                             const ddm::Decomposition& decomposition,
                                             const Condense& condense,
                                             const ddm::NeumannBoundary& neumann,
                                             bool parts = false);

// Point forces and forces on inclusions as forces on nodes.

/// Index of `name` among the mesh's `what` ("subdomain", "inclusion"). Throws errors::Error
/// (invalid_argument at `field`), whose message lists the known names.
std::size_t index_of(const std::vector<std::string>& names, const std::string& name,
                     const std::string& what, const std::string& field);

/// A force to add to the load of one node of a subdomain.
struct NodalForce {
  std::int32_t node = 0;  ///< in the subdomain's numbering
  double value = 0;
};

struct PlacedForces {
  std::vector<std::vector<NodalForce>> subdomains;  ///< one list per subdomain
  std::vector<contact::InclusionForce> inclusions;  ///< as LoadOnTraces::inclusion_forces
  std::vector<mesh::Point> points;                  ///< where one acts on the membrane itself
  /// Forces and moments that move nothing, as what they act on is held or does not turn that way.
  std::vector<std::string> warnings;
};

/// A point force on an edge of an inclusion, bonded or delaminated, acts on the inclusion;
/// elsewhere on the corners of the triangle that contains it, by barycentric coordinates (int delta
/// phi_i). A force on an inclusion acts at its middle. If the inclusion does not tilt, the force is
/// put on one trace node, since all share the displacement; if it tilts, the force and the moments
/// are put on all of them, as the least forces that do the same work on the free motions. Throws
/// errors::Error (invalid_argument): "point_forces[I].at" for a point outside the membrane or on a
/// crack without inclusion, "inclusion_forces[NAME]" and "inclusion_moments[NAME]" for an unknown
/// inclusion, or a moment on one that does not tilt. O(m log k + hits) for k points.
PlacedForces place_forces(const fem::Load& load, const mesh::Mesh& mesh,
                          const ddm::Decomposition& decomposition);

}  // namespace anticrack::operators
