// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/front_kernel.hpp"

namespace anticrack::ddm {

bool eliminate_small_front_baseline(int columns, int height, double* panel, double* update,
                                    bool add);
bool eliminate_small_front_avx2(int columns, int height, double* panel, double* update, bool add);
bool eliminate_small_front_avx512(int columns, int height, double* panel, double* update, bool add);

FrontKernel front_kernel(Instructions instructions) noexcept {
  return version_for(instructions, eliminate_small_front_baseline, eliminate_small_front_avx2,
                     eliminate_small_front_avx512);
}

bool eliminate_small_front(int columns, int height, double* panel, double* update, bool add) {
  static const FrontKernel kernel = front_kernel(best_instructions());
  return kernel(columns, height, panel, update, add);
}

}  // namespace anticrack::ddm
