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

/// A load case condensed to the traces.
struct LoadOnTraces {
  std::vector<ddm::CondensedLoad> subdomains;  ///< one per subdomain
  /// Total force on each of Mesh::inclusions, point forces included. Already in `g` of
  /// `subdomains`, at one trace node of the inclusion.
  std::vector<double> inclusion_forces;
  std::vector<std::string> warnings;  ///< integrals that reached a limit, with their error bound
};

using CondensedOutcome = std::variant<LoadOnTraces, errors::Error>;

/// Integrates all loads on the membrane (paper: f, g_D; tractions, point forces, forces on
/// inclusions) and condenses them to the traces: one forward solve per subdomain and load, two
/// where g_D is not zero, in blocks of loads. `operators`: one per subdomain of the decomposition
/// of `mesh`. Entry i holds the result or error of loads[i]: invalid_argument (unknown subdomain or
/// inclusion, array of another length, point force outside or on a crack, overflow),
/// expression_invalid, or cancelled if `stop` came first.
std::vector<CondensedOutcome> condense_loads(std::span<const fem::Load* const> loads,
                                             const mesh::Mesh& mesh,
                                             const ddm::Decomposition& decomposition,
                                             std::span<const ddm::SubdomainOperator> operators,
                                             const ddm::NeumannBoundary& neumann,
                                             const std::stop_token& stop);

}  // namespace anticrack::operators
