// SPDX-License-Identifier: GPL-3.0-or-later
#define ANTICRACK_FLUX_KERNELS flux_baseline
#include "estimate/flux_loops.hpp"
