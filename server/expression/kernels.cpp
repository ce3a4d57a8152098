// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/kernels.hpp"

#include <cmath>

#include "expression/kernel_table.hpp"

namespace anticrack::expression {
namespace {

struct Plain {
  using Numbers = double;
  static constexpr std::size_t width = 1;
  static double load(const double* from) { return *from; }
  static void store(double* to, double value) { *to = value; }
  static double all(double value) { return value; }
  static double power(double a, double b) { return std::pow(a, b); }
  static double square_root(double a) { return std::sqrt(a); }
  static double exponential(double a) { return std::exp(a); }
  static double logarithm(double a) { return std::log(a); }
  static double logarithm2(double a) { return std::log2(a); }
  static double logarithm10(double a) { return std::log10(a); }
  static double sine(double a) { return std::sin(a); }
  static double cosine(double a) { return std::cos(a); }
  static double tangent(double a) { return std::tan(a); }
  static double arc_sine(double a) { return std::asin(a); }
  static double arc_cosine(double a) { return std::acos(a); }
  static double arc_tangent(double a) { return std::atan(a); }
  static double hyperbolic_sine(double a) { return std::sinh(a); }
  static double hyperbolic_cosine(double a) { return std::cosh(a); }
  static double hyperbolic_tangent(double a) { return std::tanh(a); }
  static double area_sine(double a) { return std::asinh(a); }
  static double area_cosine(double a) { return std::acosh(a); }
  static double area_tangent(double a) { return std::atanh(a); }
  static double arc_tangent2(double a, double b) { return std::atan2(a, b); }
  static double absolute(double a) { return std::abs(a); }
  static double minimum(double a, double b) { return b < a ? b : a; }
  static double maximum(double a, double b) { return a < b ? b : a; }
  static double lower(double a) { return std::floor(a); }
  static double upper(double a) { return std::ceil(a); }
  static double less(double a, double b) { return a < b ? 1 : 0; }
  static double less_equal(double a, double b) { return a <= b ? 1 : 0; }
  static double equal(double a, double b) { return a == b ? 1 : 0; }
  static double unequal(double a, double b) { return a != b ? 1 : 0; }
  static double select(double a, double b, double c) { return a != 0 ? b : c; }
};

}  // namespace

#ifdef ANTICRACK_AVX2
const Kernels& avx2_kernels();
#endif

const Kernels& plain_kernels() {
  static constexpr Kernels kernels = KernelTable<Plain>::make();
  return kernels;
}

const Kernels& fastest_kernels() {
#ifdef ANTICRACK_AVX2
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) {
    return avx2_kernels();
  }
#endif
  return plain_kernels();
}

}  // namespace anticrack::expression
