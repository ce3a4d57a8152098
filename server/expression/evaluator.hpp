// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "expression/kernels.hpp"
#include "expression/tape.hpp"

namespace anticrack::expression {

/// Computes some operations of a tape, the roots, in many points at once. Belongs to one thread.
class Evaluator {
 public:
  /// Points of one call, at most: as many as keep the intermediate results in the processor's
  /// first-level cache.
  static constexpr std::size_t block = 256;

  Evaluator(const Tape& tape, std::span<const Ref> roots);

  /// At (x[i], y[i]), i < n <= block. Both arrays are read up to the next multiple of kernel_width.
  void operator()(const double* x, const double* y, std::size_t n);

  /// n values of a root, until the next call.
  const double* values(std::size_t root) const { return _pointers[_roots[root]]; }

  /// Time of a point, roughly, ns.
  double cost() const noexcept { return _cost; }

 private:
  struct Step {
    Kernel kernel;
    std::size_t a, b, c, out;
  };

  std::vector<Step> _steps;
  std::vector<std::size_t> _roots;       ///< slot of each
  std::vector<double> _storage;          ///< of slots, `block` numbers each
  std::vector<const double*> _pointers;  ///< to slots: 0 is x, 1 is y
  std::vector<double*> _writable;
  double _cost = 0;
};

}  // namespace anticrack::expression
