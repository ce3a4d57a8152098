// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "ddm/decomposition.hpp"
#include "ddm/neumann_boundary.hpp"
#include "ddm/subdomain_operator.hpp"
#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::operators {

/// A load case as the traces feel it.
struct LoadOnTraces {
  std::vector<ddm::CondensedLoad> subdomains;  ///< one per subdomain
  /// One per Mesh::inclusions: the force that acts on it, point forces on it counted. It is in `g`
  /// of `subdomains` already, at one trace node that the inclusion holds.
  std::vector<double> inclusion_forces;
  std::vector<std::string> warnings;  ///< an integral that met a limit, with how wrong it may be
};

using CondensedOutcome = std::variant<LoadOnTraces, errors::Error>;

/// Integrates everything that acts on the membrane (paper: f, g_D; and tractions, point forces,
/// forces on inclusions) and condenses it to the traces: one forward solve a subdomain and load,
/// two where g_D is not zero, in blocks of loads. `operators`: one per subdomain of the
/// decomposition, `mesh` the one it was cut from. Entry i belongs to loads[i]. What is wrong with a
/// load is its entry and no other's: invalid_argument for a subdomain or inclusion that the mesh
/// does not have, an array of another length than the mesh's, a point force outside or on a crack
/// (place_forces.hpp), an overflow; expression_invalid. `stop` is obeyed within a load: those not
/// done by then are `cancelled`.
std::vector<CondensedOutcome> condense_loads(std::span<const fem::Load* const> loads,
                                             const mesh::Mesh& mesh,
                                             const ddm::Decomposition& decomposition,
                                             std::span<const ddm::SubdomainOperator> operators,
                                             const ddm::NeumannBoundary& neumann,
                                             const std::stop_token& stop);

}  // namespace anticrack::operators
