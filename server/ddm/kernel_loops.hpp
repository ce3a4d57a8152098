// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loops of kernels.hpp: include it once in a file compiled for an instruction set, with
// ANTICRACK_KERNELS the name of the Kernels and ANTICRACK_ROWS the rows of a block that fit its
// registers. Calls no function of a library: an inline one compiled here could be linked into code
// for any processor.
#include "ddm/kernels.hpp"

namespace anticrack::ddm {
namespace {

/// Prefetches `count` values of L. The processor predicts long columns only, and most columns of a
/// factor are short: without this, forward substitution takes a sixth longer, backward three
/// tenths. Into the second-level cache, as the first holds the vector. Addresses outside the factor
/// do no harm.
inline void fetch(const double* values, int count) {
  constexpr int cache_line = 64 / sizeof(double);
  for (int i = 0; i < count; i += cache_line) __builtin_prefetch(values + i, 0, 2);
}

/// How far ahead, in values: some panels of a small supernode.
constexpr int ahead = 1024;

}  // namespace
}  // namespace anticrack::ddm

#include "ddm/forward_kernel.hpp"
// Needs the forward kernel.
#include "ddm/backward_kernel.hpp"
#include "ddm/front_kernel.hpp"

namespace anticrack::ddm {

extern const Kernels ANTICRACK_KERNELS{forward_solve, backward_solve, eliminate_small_front};

}  // namespace anticrack::ddm
