// SPDX-License-Identifier: GPL-3.0-or-later
//
// For the loops of forward_kernel.hpp and backward_kernel.hpp.
#pragma once

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
