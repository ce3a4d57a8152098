// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/blas.hpp"

#include <cblas.h>

#include <cstdlib>
#include <string_view>

#include "errors/errors.hpp"

// Not in OpenBLAS's header, and absent from a library built for one processor.
extern "C" {
[[gnu::weak]] void gotoblas_dynamic_init();
[[gnu::weak]] void gotoblas_dynamic_quit();
}

namespace anticrack::ddm {
namespace {

/// For a processor younger than itself OpenBLAS 0.3.21 takes kernels for one of 2004, at a fraction
/// of the speed. This has it choose again, by instructions; OPENBLAS_CORETYPE still rules. To be
/// called while no other thread uses BLAS.
void choose_kernels() {
#ifdef __x86_64__
  if (gotoblas_dynamic_init == nullptr || gotoblas_dynamic_quit == nullptr ||
      std::string_view(openblas_get_corename()) != "Prescott" || !__builtin_cpu_supports("avx2"))
    return;
  setenv("OPENBLAS_CORETYPE", __builtin_cpu_supports("avx512vl") ? "SkylakeX" : "Haswell", 0);
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
#endif
}

}  // namespace

void require_threadsafe_blas() {
  constexpr int pthreads = 1;  // 0: serial, 2: OpenMP
  if (openblas_get_parallel() != pthreads) {
    throw errors::Error(errors::Reason::internal,
                        "the BLAS in use is OpenBLAS with parallel model {} (0 serial, 2 OpenMP); "
                        "install libopenblas0-pthread and select it with update-alternatives, or "
                        "factors come out wrong under threads",
                        openblas_get_parallel());
  }
  // Done once only, as it is a global setting and other threads may be computing by now.
  static const bool set = [] {
    openblas_set_num_threads(1);
    choose_kernels();
    return true;
  }();
  static_cast<void>(set);
}

void multiply_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& a, const double* x, double* y) {
  const int size = static_cast<int>(a.rows()), lda = static_cast<int>(a.outerStride());
  if (size == 0) return;  // BLAS would complain of lda = 0
  // Of the upper half: for the lower one OpenBLAS 0.3.21 reads beyond the end of the matrix, which
  // may be where memory ends, on processors that it does not know.
  cblas_dsymv(CblasColMajor, CblasUpper, size, 1, a.data(), lda, x, 1, 0, y, 1);
}

}  // namespace anticrack::ddm
