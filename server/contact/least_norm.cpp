// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/least_norm.hpp"

#include <Eigen/QR>

namespace anticrack::contact {

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a) {
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}

}  // namespace anticrack::contact
