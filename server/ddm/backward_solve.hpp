// SPDX-License-Identifier: GPL-3.0-or-later
//
// Backward substitution with a supernodal factor.
#pragma once

#include "ddm/forward_solve.hpp"

namespace anticrack::ddm {

/// With I the first `columns` unknowns of the factor and G the others:
///
///   y_I <- L_II'^-1 (y_I - L_GI' y_G)
///
/// `width` and `y` as of forward_solve(), and as there the bits of a column depend neither on the
/// width nor on the other columns. O(nnz(L) width): one load costs about reading L from memory
/// once. What supernodes have above their diagonal is finite. No allocation.
void backward_solve(const Supernodes& factor, int width, double* y);

using BackwardKernel = void (*)(const Supernodes& factor, int width, double* y);
/// Null where the processor does not have the instructions.
BackwardKernel backward_kernel(Instructions instructions) noexcept;

}  // namespace anticrack::ddm
