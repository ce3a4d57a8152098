// SPDX-License-Identifier: GPL-3.0-or-later
//
// The best version that the processor supports of each function of kernels_*.cpp.
#include "ddm/front_kernel.hpp"
#include "ddm/substitution.hpp"

namespace anticrack::ddm {

void forward_solve_baseline(const Supernodes& factor, int width, double* y);
void forward_solve_avx2(const Supernodes& factor, int width, double* y);
void forward_solve_avx512(const Supernodes& factor, int width, double* y);
void backward_solve_baseline(const Supernodes& factor, int width, double* y);
void backward_solve_avx2(const Supernodes& factor, int width, double* y);
void backward_solve_avx512(const Supernodes& factor, int width, double* y);
bool eliminate_small_front_baseline(int columns, int height, double* panel, double* update,
                                    bool add);
bool eliminate_small_front_avx2(int columns, int height, double* panel, double* update, bool add);
bool eliminate_small_front_avx512(int columns, int height, double* panel, double* update, bool add);

SubstitutionKernel forward_kernel(Instructions instructions) noexcept {
  return version_for(instructions, forward_solve_baseline, forward_solve_avx2,
                     forward_solve_avx512);
}

SubstitutionKernel backward_kernel(Instructions instructions) noexcept {
  return version_for(instructions, backward_solve_baseline, backward_solve_avx2,
                     backward_solve_avx512);
}

FrontKernel front_kernel(Instructions instructions) noexcept {
  return version_for(instructions, eliminate_small_front_baseline, eliminate_small_front_avx2,
                     eliminate_small_front_avx512);
}

void forward_solve(const Supernodes& factor, int width, double* y) {
  static const SubstitutionKernel kernel = forward_kernel(best_instructions());
  kernel(factor, width, y);
}

void backward_solve(const Supernodes& factor, int width, double* y) {
  static const SubstitutionKernel kernel = backward_kernel(best_instructions());
  kernel(factor, width, y);
}

bool eliminate_small_front(int columns, int height, double* panel, double* update, bool add) {
  static const FrontKernel kernel = front_kernel(best_instructions());
  return kernel(columns, height, panel, update, add);
}

}  // namespace anticrack::ddm
