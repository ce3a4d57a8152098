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
/// O(nnz(L)), about reading L from memory once.
void backward_solve(const Supernodes& factor, double* y);

}  // namespace anticrack::ddm
