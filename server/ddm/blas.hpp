// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace anticrack::ddm {

/// Throws errors::Error (internal) unless BLAS is the pthread build of OpenBLAS: under threads, the
/// serial build gave 40 wrong factors of 44, without an error. Sets one thread per caller, and
/// kernels for the processor's instructions where OpenBLAS does not know the processor.
void require_threadsafe_blas();

/// y = a x with the upper half of a symmetric matrix, by BLAS. O(n^2).
void multiply_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& a, const double* x, double* y);

}  // namespace anticrack::ddm
