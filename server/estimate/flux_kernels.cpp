// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/flux_kernels.hpp"

namespace anticrack::estimate {

extern const FluxKernels flux_baseline, flux_avx2;

const FluxKernels* supported_flux_kernels(int rank) noexcept {
#if defined(__x86_64__) && !defined(__clang__)  // clang 14 does not know the levels
  if (__builtin_cpu_supports("x86-64-v3") != 0 && rank-- == 0) return &flux_avx2;
#endif
  return rank == 0 ? &flux_baseline : nullptr;
}

}  // namespace anticrack::estimate
