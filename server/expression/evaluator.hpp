// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "expression/kernels.hpp"
#include "expression/tape.hpp"

namespace anticrack::expression {

/// Computes some operations of a tape, the roots, at many points at once. Belongs to one thread.
class Evaluator {
 public:
  /// Most points of one call; with so many the intermediate results stay in the first-level cache.
  static constexpr std::size_t block = 256;

  Evaluator(const Tape& tape, std::span<const Ref> roots);

  /// Evaluates at (x[i], y[i]), i < n <= block. Reads both up to the next multiple of kernel_width.
  void operator()(const double* x, const double* y, std::size_t n);

  /// The n values of a root, valid until the next call.
  const double* values(std::size_t root) const { return _pointers[_roots[root]]; }

  /// Time that a point takes, roughly, in ns.
  double cost() const noexcept { return _cost; }

 private:
  struct Step {
    Kernel kernel;
    std::size_t a, b, c, out;
  };

  std::vector<Step> _steps;
  std::vector<std::size_t> _roots;       ///< slot of each root
  std::vector<double> _storage;          ///< the slots, `block` numbers each
  std::vector<const double*> _pointers;  ///< to slots: 0 is x, 1 is y
  std::vector<double*> _writable;
  double _cost = 0;
};

}  // namespace anticrack::expression
