// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace anticrack::contact {

/// L with L L' = the symmetric matrix whose lower triangle `matrix` holds, into that triangle. By
/// LAPACK: Eigen's is compiled for the oldest x86-64 and takes twice as long from some 60 rows.
/// False where the matrix is not positive definite. Same matrix, same bits.
bool cholesky(Eigen::Ref<Eigen::MatrixXd> matrix);

}  // namespace anticrack::contact
