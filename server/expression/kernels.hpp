// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "expression/tape.hpp"

namespace anticrack::expression {

/// out[i] = an operation on a[i], b[i], c[i] for i < n; an operand the operation lacks is not read.
/// May read and write up to the next multiple of `kernel_width` numbers.
using Kernel = void (*)(const double* a, const double* b, const double* c, double* out,
                        std::size_t n);
constexpr std::size_t kernel_width = 4;

/// By Code.
using Kernels = std::array<Kernel, static_cast<std::size_t>(Code::count)>;

/// One number after the other, by the C library. Reads and writes no more than n.
const Kernels& plain_kernels();

/// The fastest of this processor. Elementary functions are right to 1 unit in the last place; the
/// same processor always gives the same bits.
const Kernels& fastest_kernels();

}  // namespace anticrack::expression
