// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_KERNEL forward_solve_baseline
#define ANTICRACK_ROWS 4
#include "ddm/forward_kernel.hpp"
