// SPDX-License-Identifier: GPL-3.0-or-later
//
// One load at a time, where the library recovers many.
#pragma once

#include "ddm/subdomain_operator.hpp"

namespace anticrack::testing {

inline Eigen::VectorXd recovered(const ddm::SubdomainFactor& factor,
                                 const Eigen::VectorXd& z_interior, const Eigen::VectorXd& trace) {
  Eigen::VectorXd u(factor.interior() + factor.trace());
  ddm::SubdomainFactor::Backward one{z_interior, trace, u};
  factor.recover({&one, 1});
  return u;
}

inline Eigen::VectorXd recovered(const ddm::SubdomainOperator& factorised,
                                 const ddm::CondensedLoad& load, const Eigen::VectorXd& trace) {
  const ddm::SubdomainFactor& factor = factorised.factor();
  Eigen::VectorXd u(factor.interior() + factor.trace() + load.dirichlet.size());
  ddm::SubdomainOperator::Solved one{load, trace, u};
  factorised.recover({&one, 1});
  return u;
}

}  // namespace anticrack::testing
