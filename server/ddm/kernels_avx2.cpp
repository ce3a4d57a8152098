// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_KERNELS kernels_avx2
#define ANTICRACK_ROWS 4
#include "ddm/kernel_loops.hpp"
