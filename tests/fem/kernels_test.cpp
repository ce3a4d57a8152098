// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whatever this processor would choose: every set of kernels that it can run gives the values of
// the C library.
#include "expression/kernels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "expression/operations.hpp"

namespace anticrack::expression {
namespace {

#define ANTICRACK_TEXT(code, name, time, value) #code,
/// By Code: the first three are no operations.
constexpr std::array names{"", "", "", ANTICRACK_OPERATIONS(ANTICRACK_TEXT)};
static_assert(names.size() == std::tuple_size_v<Kernels>);
#undef ANTICRACK_TEXT

/// Every pair of special and random numbers.
std::array<std::vector<double>, 3> operands() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::vector<double> numbers{0.,   -0.,   1.,    -1.,    0.5, -0.5, 2.,  -2.,
                              1e-9, -1e-9, 1e150, -1e150, inf, -inf, 1e5, std::nan("")};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> near(-3, 3);
  while (numbers.size() < 48) numbers.push_back(near(random));
  std::array<std::vector<double>, 3> result;
  for (const double a : numbers) {
    for (const double b : numbers) {
      result[0].push_back(a);
      result[1].push_back(b);
      result[2].push_back(numbers[random() % numbers.size()]);
    }
  }
  return result;  // 48^2: a multiple of kernel_width
}

/// To 4 units in the last place.
bool same(double value, double expected) {
  if (std::isnan(expected)) return std::isnan(value);
  return value == expected || std::abs(value - expected) <=
                                  4 * std::numeric_limits<double>::epsilon() * std::abs(expected);
}

void expect_plain_values(const Kernels& kernels) {
  const auto [a, b, c] = operands();
  std::vector<double> expected(a.size()), values(a.size());
  for (std::size_t code = 3; code < kernels.size(); ++code) {
    plain_kernels[code](a.data(), b.data(), c.data(), expected.data(), a.size());
    kernels[code](a.data(), b.data(), c.data(), values.data(), a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_TRUE(same(values[i], expected[i]))
          << names[code] << " of " << a[i] << ", " << b[i] << ", " << c[i] << ": " << values[i]
          << ", not " << expected[i];
    }
  }
}

#ifdef __x86_64__
TEST(Kernels, OfFourNumbersGiveThePlainValues) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    GTEST_SKIP() << "this processor has no AVX2";
  expect_plain_values(avx2_kernels);
}

TEST(Kernels, OfEightNumbersGiveThePlainValues) {
  if (!__builtin_cpu_supports("avx512f")) GTEST_SKIP() << "this processor has no AVX-512";
  expect_plain_values(avx512_kernels);
}
#endif

}  // namespace
}  // namespace anticrack::expression
