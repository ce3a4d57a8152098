// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_KERNEL forward_solve_avx512
#define ANTICRACK_ROWS 16
#include "ddm/forward_kernel.hpp"
