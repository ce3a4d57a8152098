// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compiled for AVX-512F: only called on processors that have them.
#include <immintrin.h>
#include <sleef.h>

#define ELEMENTARY(f, ...) Sleef_##f##d8_u10avx512f(__VA_ARGS__)
#define PERIODIC(f, a) Sleef_##f##d8_u35avx512f(a)
#define EXACT(f, a) Sleef_##f##d8_avx512f(a)
using Numbers = __m512d;
#define ANTICRACK_KERNELS avx512_kernels
#include "expression/kernel_table.hpp"
