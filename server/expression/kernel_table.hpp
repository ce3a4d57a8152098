// SPDX-License-Identifier: GPL-3.0-or-later
//
// The kernels for `Numbers`, one or several at once. A source that includes this defines Numbers,
// ELEMENTARY, PERIODIC, EXACT and ANTICRACK_KERNELS, the name of the table. It uses no inline
// function of the standard library: the linker could take one compiled for AVX2 for the whole
// program.
#include "expression/kernels.hpp"

namespace anticrack::expression {
namespace {

constexpr Numbers zero = Numbers{}, one = zero + 1.0, half = zero + 0.5;

inline Numbers load(const double* from) {
  Numbers result;
  __builtin_memcpy(&result, from, sizeof result);
  return result;
}

#define KERNEL(code, name, cost, value)                                                          \
  [](const double* of_a, const double* of_b, const double* of_c, double* out, std::size_t n) {   \
    for (std::size_t i = 0; i < n; i += sizeof(Numbers) / sizeof(double)) {                      \
      [[maybe_unused]] const Numbers a = load(of_a + i), b = load(of_b + i), c = load(of_c + i); \
      const Numbers result = value;                                                              \
      __builtin_memcpy(out + i, &result, sizeof result);                                         \
    }                                                                                            \
  },
constexpr Kernels kernels{nullptr, nullptr, nullptr, ANTICRACK_OPERATIONS(KERNEL)};
#undef KERNEL

}  // namespace

constinit const Kernels ANTICRACK_KERNELS = kernels;

}  // namespace anticrack::expression
