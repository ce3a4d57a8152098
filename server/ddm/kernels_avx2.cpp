// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_KERNEL forward_solve_avx2
#define ANTICRACK_ROWS 4
#include "ddm/forward_kernel.hpp"

#define ANTICRACK_BACKWARD backward_solve_avx2
#include "ddm/backward_kernel.hpp"

#define ANTICRACK_FRONT eliminate_small_front_avx2
#include "ddm/front_loops.hpp"
