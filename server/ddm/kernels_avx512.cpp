// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_KERNEL forward_solve_avx512
#define ANTICRACK_ROWS 16
#include "ddm/forward_kernel.hpp"

#define ANTICRACK_BACKWARD backward_solve_avx512
#include "ddm/backward_kernel.hpp"

#define ANTICRACK_FRONT eliminate_small_front_avx512
#include "ddm/front_loops.hpp"
