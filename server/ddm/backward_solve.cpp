// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/backward_solve.hpp"

namespace anticrack::ddm {

void backward_solve_baseline(const Supernodes& factor, int width, double* y);
void backward_solve_avx2(const Supernodes& factor, int width, double* y);
void backward_solve_avx512(const Supernodes& factor, int width, double* y);

BackwardKernel backward_kernel(Instructions instructions) noexcept {
  return version_for(instructions, backward_solve_baseline, backward_solve_avx2,
                     backward_solve_avx512);
}

void backward_solve(const Supernodes& factor, int width, double* y) {
  static const BackwardKernel kernel = backward_kernel(best_instructions());
  kernel(factor, width, y);
}

}  // namespace anticrack::ddm
