// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "expression/tape.hpp"

namespace anticrack::expression {

/// out[i] = an operation on a[i], b[i], c[i] for i < n. Reads and writes up to the next multiple of
/// `kernel_width` numbers, and reads b and c even where the operation has fewer operands.
using Kernel = void (*)(const double* a, const double* b, const double* c, double* out,
                        std::size_t n);
constexpr std::size_t kernel_width = 8;

/// One kernel per Code.
using Kernels = std::array<Kernel, static_cast<std::size_t>(Code::count)>;

/// Kernels for one number at a time, by the C library. They read and write exactly n numbers.
extern const Kernels plain_kernels;

/// Kernels for four and eight numbers at a time, by SLEEF: asinh and acosh of numbers above 1e154
/// are infinite. Only in programs for x86-64.
extern const Kernels avx2_kernels, avx512_kernels;

/// The fastest kernels that this processor can run. Elementary functions are accurate to 1 unit in
/// the last place, sine and cosine to 3.5; the same processor always gives the same bits.
const Kernels& fastest_kernels();

}  // namespace anticrack::expression
