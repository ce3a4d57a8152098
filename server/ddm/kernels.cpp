// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/kernels.hpp"

namespace anticrack::ddm {

extern const Kernels kernels_baseline, kernels_avx2, kernels_avx512;

const Kernels* supported_kernels(int rank) noexcept {
#if defined(__x86_64__) && !defined(__clang__)  // clang 14 does not know the levels
  if (__builtin_cpu_supports("x86-64-v4") != 0 && rank-- == 0) return &kernels_avx512;
  if (__builtin_cpu_supports("x86-64-v3") != 0 && rank-- == 0) return &kernels_avx2;
#endif
  return rank == 0 ? &kernels_baseline : nullptr;
}

const Kernels& best_kernels() noexcept {
  static const Kernels& best = *supported_kernels(0);
  return best;
}

}  // namespace anticrack::ddm
