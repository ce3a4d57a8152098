// SPDX-License-Identifier: GPL-3.0-or-later
//
// Forward substitution with a supernodal factor, for one load or a block of them.
#pragma once

#include "ddm/instructions.hpp"

namespace anticrack::ddm {

/// A supernodal lower triangular factor as CHOLMOD stores it (is_super, is_ll): supernode s has the
/// columns super[s] to super[s+1], the rows rows[row_begin[s]] to rows[row_begin[s+1]] (its own
/// columns first), and its values column-major from values[value_begin[s]]. Index base 0.
struct Supernodes {
  int count = 0;
  int columns = 0;  ///< of L that are used, from the first
  const int* super = nullptr;
  const int* row_begin = nullptr;
  const int* value_begin = nullptr;
  const int* rows = nullptr;
  const double* values = nullptr;
};

/// Columns that a block is made of.
constexpr int lanes = 8;
constexpr int most_lanes = 4 * lanes;

/// With I the first `columns` unknowns and G the others, L = [L_II 0; L_GI L_GG]:
///
///   y_I <- L_II^-1 y_I,   y_G <- y_G - L_GI y_I
///
/// so y_G is the condensed load, and L_GG is not touched. `y`: a row of `width` doubles for each
/// unknown, width 1 or a multiple of `lanes` up to `most_lanes`; rows of a block aligned to 64
/// bytes. The bits of a column depend neither on the width nor on the other columns: each of its
/// entries is formed by the same operations in the same order. The best kernel of the processor is
/// used, so bits may differ between machines. O(nnz(L) width): one load costs about reading L from
/// memory once. No allocation.
void forward_solve(const Supernodes& factor, int width, double* y);

using ForwardKernel = void (*)(const Supernodes& factor, int width, double* y);
/// Null where the processor does not have the instructions.
ForwardKernel forward_kernel(Instructions instructions) noexcept;

}  // namespace anticrack::ddm
