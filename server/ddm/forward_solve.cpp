// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/forward_solve.hpp"

namespace anticrack::ddm {

void forward_solve_baseline(const Supernodes& factor, int width, double* y);
void forward_solve_avx2(const Supernodes& factor, int width, double* y);
void forward_solve_avx512(const Supernodes& factor, int width, double* y);

ForwardKernel forward_kernel(Instructions instructions) noexcept {
  return version_for(instructions, forward_solve_baseline, forward_solve_avx2,
                     forward_solve_avx512);
}

void forward_solve(const Supernodes& factor, int width, double* y) {
  static const ForwardKernel kernel = forward_kernel(best_instructions());
  kernel(factor, width, y);
}

}  // namespace anticrack::ddm
