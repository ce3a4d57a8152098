// SPDX-License-Identifier: GPL-3.0-or-later
//
// For the loops of forward_kernel.hpp and backward_kernel.hpp.
#pragma once

namespace anticrack::ddm {
namespace {

/// Asks the memory for `count` values of L that are needed soon. The processor foresees a long
/// column by itself, but most columns of a factor end before it has seen what they are; a sixth of
/// forward substitution, and three tenths of a backward one. Into the second-level cache: what
/// comes into the first one displaces the vector. An address outside of the factor does no harm.
inline void fetch(const double* values, int count) {
  constexpr int cache_line = 64 / sizeof(double);
  for (int i = 0; i < count; i += cache_line) __builtin_prefetch(values + i, 0, 2);
}

/// How far ahead, in values: some panels of a small supernode.
constexpr int ahead = 1024;

}  // namespace
}  // namespace anticrack::ddm
