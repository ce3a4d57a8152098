// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inner loops compiled for several instruction sets. kernel_loops.hpp includes this file, so it
// must not include anything.
#pragma once

namespace anticrack::ddm {

/// A supernodal lower triangular factor as CHOLMOD stores it (is_super, is_ll), index base 0.
/// Supernode s has the columns super[s] to super[s+1], the rows rows[row_begin[s]] to
/// rows[row_begin[s+1]] (its own columns first), and its values column-major from
/// values[value_begin[s]].
struct Supernodes {
  int count = 0;
  int columns = 0;  ///< the first columns of L, which are used
  const int* super = nullptr;
  const int* row_begin = nullptr;
  const int* value_begin = nullptr;
  const int* rows = nullptr;
  const double* values = nullptr;
  /// The kernels call this about every millisecond and pass on what it throws; may be null.
  void (*look)() = nullptr;
};

/// A block has 1 column, `few_lanes`, or a multiple of `lanes`, at most `most_lanes`.
constexpr int few_lanes = 4;
constexpr int lanes = 8;
constexpr int most_lanes = 4 * lanes;

/// The loops compiled for one instruction set.
struct Kernels {
  /// With I the first `columns` unknowns, G the others and L = [L_II; L_GI]:
  ///
  ///   forward:   y_I <- L_II^-1 y_I,  y_G <- y_G - L_GI y_I   (y_G: the condensed load)
  ///   backward:  y_I <- L_II'^-1 (y_I - L_GI' y_G)            (finite values above L's diagonal)
  ///
  /// `y`: a row of `width` doubles for each unknown; rows of a block are aligned to 64 bytes. The
  /// bits of a column depend neither on the width nor on the other columns, since all entries are
  /// formed by the same operations in the same order. They may differ between processors, as each
  /// uses its best kernel. O(nnz(L) width); one load costs about reading L once, or
  /// forward, of a force on a few nodes, what L has on their ways to the root. No allocation.
  void (*forward)(const Supernodes& factor, int width, double* y);
  void (*backward)(const Supernodes& factor, int width, double* y);
  /// eliminate_front() (multifrontal.hpp) by plain loops, for fronts too small for BLAS. Bits may
  /// differ between processors.
  bool (*eliminate_small_front)(int columns, int height, double* panel, double* update, bool add);
};

/// The kernels that this processor supports: rank 0 is the best; null beyond the last.
const Kernels* supported_kernels(int rank) noexcept;

/// The best kernels that this processor supports.
const Kernels& best_kernels() noexcept;

}  // namespace anticrack::ddm
