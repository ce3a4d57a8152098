// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small systems that have no solution or many, by Eigen's complete orthogonal decomposition, whose
// templates take long to compile and so are compiled here alone.
#pragma once

#include <Eigen/Core>

namespace anticrack::contact {

/// The Moore-Penrose inverse of `a`, (m,n), which is (n,m). O(m n min(m, n)).
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// The shortest of all x with the least |a x - b|. O(m n min(m, n)).
Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace anticrack::contact
