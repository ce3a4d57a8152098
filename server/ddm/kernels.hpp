// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inner loops compiled for several instruction sets (kernel_loops.hpp, which is why nothing is
// included here).
#pragma once

namespace anticrack::ddm {

/// A supernodal lower triangular factor as CHOLMOD stores it (is_super, is_ll), index base 0.
/// Supernode s has the columns super[s] to super[s+1], the rows rows[row_begin[s]] to
/// rows[row_begin[s+1]] (its own columns first), and its values column-major from
/// values[value_begin[s]].
struct Supernodes {
  int count = 0;
  int columns = 0;  ///< used columns of L, from the first
  const int* super = nullptr;
  const int* row_begin = nullptr;
  const int* value_begin = nullptr;
  const int* rows = nullptr;
  const double* values = nullptr;
  /// Called about each millisecond by the kernels, which pass on what it throws; null: nothing.
  void (*look)() = nullptr;
};

/// A block has 1 column or a multiple of `lanes`, at most `most_lanes`.
constexpr int lanes = 8;
constexpr int most_lanes = 4 * lanes;

/// One version of the loops.
struct Kernels {
  /// With I the first `columns` unknowns, G the others and L = [L_II; L_GI]:
  ///
  ///   forward:   y_I <- L_II^-1 y_I,  y_G <- y_G - L_GI y_I   (y_G: the condensed load)
  ///   backward:  y_I <- L_II'^-1 (y_I - L_GI' y_G)            (finite values above L's diagonal)
  ///
  /// `y`: a row of `width` doubles for each unknown; rows of a block are aligned to 64 bytes. A
  /// column's bits depend neither on the width nor on the other columns, since all its entries are
  /// formed by the same operations in the same order; they may differ between processors, as
  /// each uses its best kernel. O(nnz(L) width); one load costs about reading L once. No
  /// allocation.
  void (*forward)(const Supernodes& factor, int width, double* y);
  void (*backward)(const Supernodes& factor, int width, double* y);
  /// eliminate_front() (multifrontal.hpp) by plain loops, for fronts too small for BLAS. Bits may
  /// differ between processors.
  bool (*eliminate_small_front)(int columns, int height, double* panel, double* update, bool add);
};

/// The versions that this processor supports, from 0, the best first; null beyond the last.
const Kernels* supported_kernels(int rank) noexcept;

/// The best of them.
const Kernels& best_kernels() noexcept;

}  // namespace anticrack::ddm
