// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_KERNELS kernels_avx512
#define ANTICRACK_ROWS 16
#include "ddm/kernel_loops.hpp"
