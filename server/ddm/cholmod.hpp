// SPDX-License-Identifier: GPL-3.0-or-later
//
// CHOLMOD's analysis; the only header that includes it.
#pragma once

#include <cholmod.h>

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace anticrack::ddm {

struct FreeFactor {
  void operator()(cholmod_factor* factor) const;
};

/// May be freed by any thread: memory comes from malloc.
using FactorPtr = std::unique_ptr<cholmod_factor, FreeFactor>;

/// Permutation and supernodal pattern of the factor of a symmetric matrix, without values. `lower`:
/// its lower triangle, compressed; `permutation`: the order of elimination, which keeps the
/// unknowns from `interior` on last and in their order. Throws errors::Error (limit_exceeded for
/// memory).
FactorPtr analyse(const Eigen::SparseMatrix<double>& lower, std::vector<int> permutation,
                  Eigen::Index interior);

}  // namespace anticrack::ddm
