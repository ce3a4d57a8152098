// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ddm/decomposition.hpp"

namespace anticrack::contact {

/// Multipliers of the node pairs from the fluxes S t - g of the traces and the contact forces.
///   contact c:   mu equal on all its pairs, sum over them of M mu = lambda_c
///   tied pairs:  S t - g = B'M mu on every side that is not rigid; where that leaves a choice
///                (sides tied in a circle around a cross point) the mu with the least mu'M mu, to
///                which Algorithm 2 converges as well.
/// A side held rigid takes any force; a pair of two such sides has mu = 0. So has a pair whose
/// condition follows from others of its cross point (contact -1, sides not tied).
/// Lumped mass. Immutable after construction. O(n) a call.
class PairForces {
 public:
  /// Keeps references to both. `lumped_mass`: shape (pairs).
  PairForces(const ddm::Decomposition& decomposition, const Eigen::VectorXd& lumped_mass);

  /// Shape (pairs). `fluxes`: per subdomain, shape (trace); `lambda`: shape (contacts).
  Eigen::VectorXd multipliers(const std::vector<Eigen::VectorXd>& fluxes,
                              const Eigen::VectorXd& lambda) const;

 private:
  struct Side {
    std::int32_t subdomain, trace;
    auto operator<=>(const Side&) const = default;
  };
  struct Touch {  // of a contact's pair on a side
    Eigen::Index side, pair;
    double sign;
  };
  /// Tied pairs that meet in a node, with the sides that must be in balance.
  struct Knot {
    std::vector<std::int32_t> pairs;
    std::vector<Side> sides;
    std::vector<Touch> contacts;
    Eigen::MatrixXd multipliers;  // (pairs, sides): mu = multipliers * force on the sides
  };
  Knot knot_of(const std::vector<std::int32_t>& pairs_of_node) const;

  const ddm::Decomposition& _decomposition;
  const Eigen::VectorXd& _mass;
  Eigen::VectorXd _contact_mass;
  std::vector<Knot> _knots;
};

}  // namespace anticrack::contact
