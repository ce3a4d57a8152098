// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small systems that have no solution or many, by LAPACK's dgelsy: Eigen's templates for them take
// a fifth of the time in which this folder is compiled.
#pragma once

#include <Eigen/Core>

namespace anticrack::contact {

/// For each column of `b`, (m,k), the shortest of all x with the least |a x - b|; `a` is (m,n), the
/// result (n,k). With the identity for `b` it is the Moore-Penrose inverse of `a`. What is below
/// min(m, n) eps of the largest pivot counts as zero. O(m n (min(m, n) + k)).
Eigen::MatrixXd least_norm_solution(Eigen::MatrixXd a, const Eigen::MatrixXd& b);

}  // namespace anticrack::contact
