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
/// A side held rigid takes any force; a pair of two such sides has mu = 0. A pair whose condition
/// follows from contacts of its cross point (contact -1, sides not tied) shares their forces: it
/// takes the part of them that makes mu'M mu least with no mu below 0, or 0 if one of these
/// contacts is open. Lumped mass. Immutable after construction. O(n) a call.
class PairForces {
 public:
  /// Keeps references to both. `lumped_mass`: shape (pairs).
  PairForces(const ddm::Decomposition& decomposition, const Eigen::VectorXd& lumped_mass);

  /// A pair whose condition follows from contacts: its jump is the sum of their jumps.
  struct Implied {
    Eigen::Index pair;
    std::vector<std::int32_t> path;  ///< the contacts between its two sides
  };
  const std::vector<Implied>& implied() const noexcept { return _implied; }

  /// The length that belongs to the pairs of each contact, shape (contacts).
  const Eigen::VectorXd& contact_mass() const noexcept { return _contact_mass; }

  /// Completes `pressed`, the contacts closed under pressure. It comes with the contacts whose
  /// force is above rounding; if there are any, those whose pressure is above 1e-12 of the largest
  /// are added, as the force on a short edge may be small. `lambda`: shape (contacts), >= 0. O(n),
  /// no allocation.
  void complete_contact(const Eigen::VectorXd& lambda, std::vector<char>& pressed) const;

  /// mu, shape (pairs). `fluxes`: per subdomain, shape (trace); `lambda`: shape (contacts).
  Eigen::VectorXd multipliers(const std::vector<Eigen::VectorXd>& fluxes,
                              const Eigen::VectorXd& lambda) const;

 private:
  struct Side {
    std::int32_t subdomain, trace;
    auto operator<=>(const Side&) const = default;
  };
  struct Touch {  // the pair of a contact at a side
    Eigen::Index side, pair;
    double sign;
  };
  /// Tied pairs that meet in a node, and the sides on which their forces must balance the fluxes.
  struct Knot {
    std::vector<std::int32_t> pairs;
    std::vector<Side> sides;
    std::vector<Touch> contacts;
    Eigen::MatrixXd multipliers;  // (pairs, sides): mu = multipliers * force on the sides
  };
  std::vector<std::int32_t> path_of(const std::vector<std::int32_t>& pairs_of_node,
                                    std::int32_t pair) const;
  Eigen::VectorXd share(const Eigen::VectorXd& lambda, Eigen::VectorXd& mu) const;
  Knot knot_of(const std::vector<std::int32_t>& pairs_of_node) const;

  const ddm::Decomposition& _decomposition;
  const Eigen::VectorXd& _mass;
  Eigen::VectorXd _contact_mass;
  std::vector<Implied> _implied;
  std::vector<Knot> _knots;
};

/// Whether all contacts of a path are closed under pressure. `pressed`: per contact.
bool pressed_through(const std::vector<std::int32_t>& path, const std::vector<char>& pressed);

}  // namespace anticrack::contact
