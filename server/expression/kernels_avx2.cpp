// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compiled for AVX2 and FMA, which the program may only use where the processor has them.
#include <immintrin.h>
#include <sleef.h>

#include "expression/kernel_table.hpp"

namespace anticrack::expression {
namespace {

struct Avx2 {
  using Numbers = __m256d;
  static constexpr std::size_t width = 4;
  static Numbers load(const double* from) { return _mm256_loadu_pd(from); }
  static void store(double* to, Numbers value) { _mm256_storeu_pd(to, value); }
  static Numbers all(double value) { return _mm256_set1_pd(value); }
  static Numbers power(Numbers a, Numbers b) { return Sleef_powd4_u10avx2(a, b); }
  static Numbers square_root(Numbers a) { return _mm256_sqrt_pd(a); }
  static Numbers exponential(Numbers a) { return Sleef_expd4_u10avx2(a); }
  static Numbers logarithm(Numbers a) { return Sleef_logd4_u10avx2(a); }
  static Numbers logarithm2(Numbers a) { return Sleef_log2d4_u10avx2(a); }
  static Numbers logarithm10(Numbers a) { return Sleef_log10d4_u10avx2(a); }
  static Numbers sine(Numbers a) { return Sleef_sind4_u10avx2(a); }
  static Numbers cosine(Numbers a) { return Sleef_cosd4_u10avx2(a); }
  static Numbers tangent(Numbers a) { return Sleef_tand4_u10avx2(a); }
  static Numbers arc_sine(Numbers a) { return Sleef_asind4_u10avx2(a); }
  static Numbers arc_cosine(Numbers a) { return Sleef_acosd4_u10avx2(a); }
  static Numbers arc_tangent(Numbers a) { return Sleef_atand4_u10avx2(a); }
  static Numbers hyperbolic_sine(Numbers a) { return Sleef_sinhd4_u10avx2(a); }
  static Numbers hyperbolic_cosine(Numbers a) { return Sleef_coshd4_u10avx2(a); }
  static Numbers hyperbolic_tangent(Numbers a) { return Sleef_tanhd4_u10avx2(a); }
  static Numbers area_sine(Numbers a) { return Sleef_asinhd4_u10avx2(a); }
  static Numbers area_cosine(Numbers a) { return Sleef_acoshd4_u10avx2(a); }
  static Numbers area_tangent(Numbers a) { return Sleef_atanhd4_u10avx2(a); }
  static Numbers arc_tangent2(Numbers a, Numbers b) { return Sleef_atan2d4_u10avx2(a, b); }
  static Numbers absolute(Numbers a) { return _mm256_andnot_pd(all(-0.0), a); }
  static Numbers minimum(Numbers a, Numbers b) { return _mm256_min_pd(b, a); }
  static Numbers maximum(Numbers a, Numbers b) { return _mm256_max_pd(b, a); }
  static Numbers lower(Numbers a) { return _mm256_floor_pd(a); }
  static Numbers upper(Numbers a) { return _mm256_ceil_pd(a); }
  static Numbers less(Numbers a, Numbers b) { return one_if(_mm256_cmp_pd(a, b, _CMP_LT_OQ)); }
  static Numbers less_equal(Numbers a, Numbers b) {
    return one_if(_mm256_cmp_pd(a, b, _CMP_LE_OQ));
  }
  static Numbers equal(Numbers a, Numbers b) { return one_if(_mm256_cmp_pd(a, b, _CMP_EQ_OQ)); }
  static Numbers unequal(Numbers a, Numbers b) { return one_if(_mm256_cmp_pd(a, b, _CMP_NEQ_UQ)); }
  static Numbers select(Numbers a, Numbers b, Numbers c) {
    return _mm256_blendv_pd(c, b, _mm256_cmp_pd(a, all(0), _CMP_NEQ_UQ));
  }

 private:
  static Numbers one_if(Numbers mask) { return _mm256_and_pd(mask, all(1)); }
};

}  // namespace

const Kernels& avx2_kernels();

const Kernels& avx2_kernels() {
  static constexpr Kernels kernels = KernelTable<Avx2>::make();
  return kernels;
}

}  // namespace anticrack::expression
