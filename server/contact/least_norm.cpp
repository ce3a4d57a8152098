// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/least_norm.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "errors/errors.hpp"

extern "C" void dgelsy_(const int* m, const int* n, const int* nrhs, double* a, const int* lda,
                        double* b, const int* ldb, int* jpvt, const double* rcond, int* rank,
                        double* work, const int* lwork, int* info);

namespace anticrack::contact {

Eigen::MatrixXd least_norm_solution(Eigen::MatrixXd a, const Eigen::MatrixXd& b) {
  const int m = static_cast<int>(a.rows()), n = static_cast<int>(a.cols());
  const int columns = static_cast<int>(b.cols()), smaller = std::min(m, n);
  if (smaller == 0 || columns == 0) return Eigen::MatrixXd::Zero(n, columns);
  const int rows = std::max(m, n), size = std::max(smaller + 3 * n + 1, 2 * smaller + columns);
  const double rcond = smaller * std::numeric_limits<double>::epsilon();
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(rows, columns);
  x.topRows(m) = b;
  std::vector<int> pivots(static_cast<std::size_t>(n), 0);
  std::vector<double> work(static_cast<std::size_t>(size));
  int rank = 0, info = 0;
  dgelsy_(&m, &n, &columns, a.data(), &m, x.data(), &rows, pivots.data(), &rcond, &rank,
          work.data(), &size, &info);
  if (info != 0)
    throw errors::Error(errors::Reason::internal, "dgelsy refuses its argument {}", -info);
  return x.topRows(n);
}

}  // namespace anticrack::contact
