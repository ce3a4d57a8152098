// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fronts too small for BLAS.
#pragma once

#include "ddm/instructions.hpp"

namespace anticrack::ddm {

/// eliminate_front() (multifrontal.hpp) by plain loops with the best instructions of the processor;
/// bits may differ between processors.
bool eliminate_small_front(int columns, int height, double* panel, double* update, bool add);

using FrontKernel = bool (*)(int columns, int height, double* panel, double* update, bool add);
/// Null where the processor lacks the instructions.
FrontKernel front_kernel(Instructions instructions) noexcept;

}  // namespace anticrack::ddm
