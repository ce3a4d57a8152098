// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <span>
#include <vector>

#include "base/lazy.hpp"
#include "contact/contact_length.hpp"
#include "contact/maps.hpp"
#include "contact/options.hpp"
#include "contact/pair_forces.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_operator.hpp"

namespace anticrack::contact {

/// The contact problem on the interfaces alone. Multipliers mu, one per node pair, act on the
/// traces as forces M mu, down on the minus and up on the plus side. Keeps references: the
/// decomposition and the operators (one per subdomain, same order) must outlive it. Thread-safe;
/// not movable.
class TraceProblem {
 public:
  TraceProblem(const TraceProblem&) = delete;
  TraceProblem& operator=(const TraceProblem&) = delete;

  /// `uzawa`: whether Algorithm 2 applies (ddm::uzawa_obstacle is empty).
  TraceProblem(const ddm::Decomposition& decomposition,
               const std::vector<ddm::SubdomainOperator>& operators, bool uzawa = true);

  const ddm::Decomposition& decomposition() const noexcept { return _decomposition; }
  const std::vector<ddm::SubdomainOperator>& operators() const noexcept { return _operators; }
  const Maps& maps() const noexcept { return _maps; }
  const PairForces& pair_forces() const noexcept { return _pair_forces; }
  const ContactLength& contact_length() const noexcept { return _contact_length; }
  /// Per subdomain and trace node: the inclusion on which the node's flux acts, directly or through
  /// contact, or -1.
  const std::vector<std::vector<std::int32_t>>& carriers() const noexcept { return _carriers; }
  /// Contacts in their order along each crack; a chain ends where a node is tied. A contact that
  /// several interfaces share is in the chain of the first. Where cracks cross, some pairs belong
  /// to no interface: their contacts come last, each a chain of its own. O(n).
  std::vector<std::vector<std::int32_t>> chains() const;
  /// Pairs of nodes, tied ones included.
  Eigen::Index pair_count() const noexcept { return _lumped.size(); }

  /// Sum over the subdomains of the forces on their traces, shape (unknowns). For loads these are
  /// their g; `loads` may be empty.
  Eigen::VectorXd gather(std::span<const Eigen::VectorXd> on_traces) const;
  Eigen::VectorXd gather(std::span<const ddm::CondensedLoad> loads) const;
  /// Values on the traces of each subdomain, from those of the skeleton's unknowns.
  std::vector<Eigen::VectorXd> scatter(const Eigen::VectorXd& w) const;

  /// Diagonal of the lumped interface mass: the length that belongs to each pair.
  const Eigen::VectorXd& lumped_mass() const noexcept { return _lumped; }

  /// force = M mu, column by column. No allocation.
  void apply_mass(Mass mass, const Eigen::Ref<const Eigen::MatrixXd>& mu,
                  Eigen::Ref<Eigen::MatrixXd> force) const;

  /// theta* = 2 / lambda_max(M^1/2 (F1 + F2) M^1/2): for 0 < theta < theta* the iteration contracts
  /// for every load (Theorem 4). Infinite without interfaces, 0 where Algorithm 2 does not apply.
  /// Computed at the first call, with the flexibilities: O(n_G^3), on large interfaces more than
  /// everything else. Throws errors::Error (numerical) when it cannot be computed.
  double theta_star(Mass mass) const;

 private:
  const base::Lazy<double>& lazy_theta_star(Mass mass) const noexcept {
    return mass == Mass::lumped ? _theta_star_lumped : _theta_star_consistent;
  }

  const ddm::Decomposition& _decomposition;
  const std::vector<ddm::SubdomainOperator>& _operators;
  Maps _maps;
  Eigen::VectorXd _lumped;
  Eigen::SparseMatrix<double> _consistent;
  PairForces _pair_forces;
  ContactLength _contact_length;
  std::vector<std::vector<std::int32_t>> _carriers;
  bool _uzawa;
  base::Lazy<double> _theta_star_lumped, _theta_star_consistent;
};

}  // namespace anticrack::contact
