// SPDX-License-Identifier: GPL-3.0-or-later
//
// One load at a time, where the library recovers many.
#pragma once

#include "ddm/subdomain_operator.hpp"

namespace anticrack::testing {

inline Eigen::VectorXd recovered(const ddm::SubdomainFactor& factor,
                                 const Eigen::VectorXd& z_interior, const Eigen::VectorXd& trace) {
  const ddm::SubdomainFactor::Backward one{z_interior, trace};
  return factor.recover({&one, 1}).front();
}

inline Eigen::VectorXd recovered(const ddm::SubdomainOperator& factorised,
                                 const ddm::CondensedLoad& load, const Eigen::VectorXd& trace) {
  const ddm::SubdomainOperator::Solved one{load, trace};
  return factorised.recover({&one, 1}).front();
}

}  // namespace anticrack::testing
