// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/blas.hpp"

#include <cblas.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <new>

namespace anticrack::ddm {
namespace {

/// Memory for an array that ends where memory ends.
class LastOfMemory {
 public:
  explicit LastOfMemory(std::size_t bytes)
      : _page(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))),
        _size((bytes + _page - 1) / _page * _page + _page),
        _begin(mmap(nullptr, _size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
    if (_begin == MAP_FAILED || mprotect(end(), _page, PROT_NONE) != 0) throw std::bad_alloc();
  }
  ~LastOfMemory() { munmap(_begin, _size); }
  LastOfMemory(const LastOfMemory&) = delete;
  LastOfMemory& operator=(const LastOfMemory&) = delete;

  std::byte* end() const { return static_cast<std::byte*>(_begin) + _size - _page; }

 private:
  std::size_t _page, _size;
  void* _begin;
};

TEST(Blas, ReadsNothingBeyondASymmetricMatrix) {
  require_threadsafe_blas();
  for (int size = 1; size <= 130; ++size) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::Random(size, size);
    const Eigen::MatrixXd whole = half + half.transpose();
    const Eigen::VectorXd x = Eigen::VectorXd::Random(size);
    const std::size_t bytes = sizeof(double) * static_cast<std::size_t>(whole.size());
    const LastOfMemory memory(bytes);
    Eigen::Map<Eigen::MatrixXd> a(reinterpret_cast<double*>(memory.end() - bytes), size, size);
    a = whole;
    Eigen::VectorXd y(size);
    multiply_symmetric(a, x.data(), y.data());
    EXPECT_LT((y - whole * x).norm(), 1e-13 * whole.norm() * x.norm()) << size;
  }
}

TEST(Blas, UsesTheProcessorsInstructions) {
#ifdef __x86_64__
  const bool chosen = std::getenv("OPENBLAS_CORETYPE") != nullptr;
  require_threadsafe_blas();
  if (!chosen && __builtin_cpu_supports("avx2")) {
    EXPECT_STRNE(openblas_get_corename(), "Prescott");
  }
#endif
}

TEST(Blas, HasNoWordForAnEmptyMatrix) {
  ::testing::internal::CaptureStdout();
  multiply_symmetric(Eigen::MatrixXd(0, 0), nullptr, nullptr);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace anticrack::ddm
