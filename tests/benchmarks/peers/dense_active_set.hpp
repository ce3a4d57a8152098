// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace anticrack::benchmarks {

/// d >= 0, S d - r >= 0, d'(S d - r) = 0 by the primal-dual active set method from "all closed",
/// with LAPACK's Cholesky on the open nodes. (c,c) column-major, both triangles.
class DenseActiveSet {
 public:
  DenseActiveSet(int contacts, std::vector<double> matrix);

  struct Solution {
    std::vector<double> d;
    int steps = 0;
  };
  /// Throws std::runtime_error where it does not end in 100 steps.
  Solution solve(const std::vector<double>& r) const;

 private:
  std::vector<double> open_solution(const std::vector<int>& open,
                                    const std::vector<double>& r) const;
  double entry(int i, int j) const {
    return _matrix[static_cast<std::size_t>(j) * static_cast<std::size_t>(_contacts) +
                   static_cast<std::size_t>(i)];
  }

  int _contacts;
  std::vector<double> _matrix;
};

}  // namespace anticrack::benchmarks
