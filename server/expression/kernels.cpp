// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/kernels.hpp"

#include <cmath>

#define ELEMENTARY(f, ...) std::f(__VA_ARGS__)
#define PERIODIC(f, a) std::f(a)
#define EXACT(f, a) std::f(a)
using Numbers = double;
#define ANTICRACK_KERNELS plain_kernels
#include "expression/kernel_table.hpp"

namespace anticrack::expression {

const Kernels& fastest_kernels() {
#ifdef ANTICRACK_X86_64
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
                    widest = __builtin_cpu_supports("avx512f");
  if (widest) return avx512_kernels;
  if (wide) return avx2_kernels;
#endif
  return plain_kernels;
}

}  // namespace anticrack::expression
