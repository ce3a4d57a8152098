// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_KERNELS kernels_baseline
#define ANTICRACK_ROWS 4
#include "ddm/kernel_loops.hpp"
