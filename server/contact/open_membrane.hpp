// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/joined_membrane.hpp"
#include "ddm/subdomain_factor.hpp"

namespace anticrack::contact {

/// The joined membrane with every contact open. It has a factor of K on [x d], so that each unit
/// force takes one solve, of many forces at once. Keeps a reference.
class OpenMembrane {
 public:
  /// Factorises K on [x d]. Throws as JoinedMembrane does.
  explicit OpenMembrane(const JoinedMembrane& membrane);

  /// u of a unit force on each sum, laid out as by ContactProblem::fields_of. `refined`: takes a
  /// second solve, and is empty where rounding errors dominate. `on_contacts`: forces that press
  /// the contacts, for each sum; empty: none. The bits for a sum do not depend on the others.
  std::vector<std::vector<double>> fields(std::span<const ddm::Terms* const> sums, bool refined,
                                          std::span<const Eigen::VectorXd> on_contacts = {}) const;

 private:
  const JoinedMembrane& _membrane;
  ddm::SubdomainFactor _factor;
};

}  // namespace anticrack::contact
