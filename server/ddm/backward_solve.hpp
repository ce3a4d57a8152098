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
/// The best kernel of the processor is used, so bits may differ between machines. O(nnz(L)), about
/// reading L from memory once. No allocation.
void backward_solve(const Supernodes& factor, double* y);

using BackwardKernel = void (*)(const Supernodes& factor, double* y);
/// Null where the processor does not have the instructions.
BackwardKernel backward_kernel(Instructions instructions) noexcept;

}  // namespace anticrack::ddm
