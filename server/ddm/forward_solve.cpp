// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/forward_solve.hpp"

namespace anticrack::ddm {

void forward_solve_baseline(const Supernodes& factor, int width, double* y);
void forward_solve_avx2(const Supernodes& factor, int width, double* y);
void forward_solve_avx512(const Supernodes& factor, int width, double* y);

namespace {

bool has(Instructions instructions) noexcept {
#if defined(__x86_64__)
  switch (instructions) {
    case Instructions::avx512:
      return __builtin_cpu_supports("x86-64-v4") != 0;
    case Instructions::avx2:
      return __builtin_cpu_supports("x86-64-v3") != 0;
    case Instructions::baseline:
      break;
  }
#endif
  return instructions == Instructions::baseline;
}

ForwardKernel best() noexcept {
  const ForwardKernel widest = forward_kernel(Instructions::avx512);
  const ForwardKernel wide = forward_kernel(Instructions::avx2);
  return widest != nullptr ? widest : wide != nullptr ? wide : forward_solve_baseline;
}

}  // namespace

ForwardKernel forward_kernel(Instructions instructions) noexcept {
  if (!has(instructions)) {
    return nullptr;
  }
  switch (instructions) {
    case Instructions::avx512:
      return forward_solve_avx512;
    case Instructions::avx2:
      return forward_solve_avx2;
    case Instructions::baseline:
      break;
  }
  return forward_solve_baseline;
}

void forward_solve(const Supernodes& factor, int width, double* y) {
  static const ForwardKernel kernel = best();
  kernel(factor, width, y);
}

}  // namespace anticrack::ddm
