// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fronts too small for BLAS.
#pragma once

#include "ddm/instructions.hpp"

namespace anticrack::ddm {

/// eliminate_front() (multifrontal.hpp) by plain loops, with the best instructions the processor
/// has: bits may differ between machines.
bool eliminate_small_front(int columns, int height, double* panel, double* update, bool add);

using FrontKernel = bool (*)(int columns, int height, double* panel, double* update, bool add);
/// Null where the processor does not have the instructions.
FrontKernel front_kernel(Instructions instructions) noexcept;

}  // namespace anticrack::ddm
