// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/peers/dense_active_set.hpp"

#include <petsc.h>
#include <petscblaslapack.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace anticrack::benchmarks {

DenseActiveSet::DenseActiveSet(int contacts, std::vector<double> matrix)
    : _contacts(contacts), _matrix(std::move(matrix)) {}

std::vector<double> DenseActiveSet::open_solution(const std::vector<int>& open,
                                                  const std::vector<double>& r) const {
  const std::size_t n = open.size();
  std::vector<double> factor(n * n), d(n);
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) factor[j * n + i] = entry(open[i], open[j]);
    d[j] = r[static_cast<std::size_t>(open[j])];
  }
  const auto size = static_cast<PetscBLASInt>(n);
  const PetscBLASInt one = 1;
  PetscBLASInt failed = 0;
  LAPACKpotrf_("L", &size, factor.data(), &size, &failed);
  if (failed != 0) throw std::runtime_error("the Schur complement is not positive definite");
  LAPACKpotrs_("L", &size, &one, factor.data(), &size, d.data(), &size, &failed);
  return d;
}

DenseActiveSet::Solution DenseActiveSet::solve(const std::vector<double>& r) const {
  const auto n = static_cast<std::size_t>(_contacts);
  Solution solution{std::vector<double>(n, 0.0), 0};
  std::vector<char> closed(n, 1);
  std::vector<double> pressure(n);
  std::vector<int> open;
  while (++solution.steps <= 100) {
    open.clear();
    for (std::size_t i = 0; i < n; ++i) {
      if (!closed[i]) open.push_back(static_cast<int>(i));
    }
    std::fill(solution.d.begin(), solution.d.end(), 0.0);
    if (!open.empty()) {
      const std::vector<double> d = open_solution(open, r);
      for (std::size_t k = 0; k < open.size(); ++k) {
        solution.d[static_cast<std::size_t>(open[k])] = d[k];
      }
    }
    for (std::size_t i = 0; i < n; ++i) pressure[i] = -r[i];
    if (!open.empty()) {
      const PetscBLASInt size = _contacts, one = 1;
      const double plus = 1;
      BLASgemv_("N", &size, &size, &plus, _matrix.data(), &size, solution.d.data(), &one, &plus,
                pressure.data(), &one);
    }
    bool changed = false;
    for (std::size_t i = 0; i < n; ++i) {
      const bool close = closed[i] ? pressure[i] >= 0 : solution.d[i] < 0;
      changed = changed || close != (closed[i] != 0);
      closed[i] = close ? 1 : 0;
    }
    if (!changed) return solution;
  }
  throw std::runtime_error("the active set does not come to rest");
}

}  // namespace anticrack::benchmarks
