// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compiled for AVX2 and FMA: only called on processors that have them.
#include <immintrin.h>
#include <sleef.h>

#define ELEMENTARY(f, ...) Sleef_##f##d4_u10avx2(__VA_ARGS__)
#define PERIODIC(f, a) Sleef_##f##d4_u35avx2(a)
#define EXACT(f, a) Sleef_##f##d4_avx2(a)
using Numbers = __m256d;
#define ANTICRACK_KERNELS avx2_kernels
#include "expression/kernel_table.hpp"
