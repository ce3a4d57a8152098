// SPDX-License-Identifier: GPL-3.0-or-later
//
// CHOLMOD's analysis. This is the only header that includes CHOLMOD.
#pragma once

#include <cholmod.h>

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace anticrack::ddm {

struct FreeFactor {
  void operator()(cholmod_factor* factor) const;
};

/// Any thread may free it, since the memory comes from malloc.
using FactorPtr = std::unique_ptr<cholmod_factor, FreeFactor>;

/// Permutation and supernodal pattern of the factor of a symmetric matrix, without values. `lower`:
/// the lower triangle of the matrix, compressed; `permutation`: the order of elimination, in which
/// the unknowns from `interior` on stay last and in their order. Throws errors::Error
/// (limit_exceeded) if there is not enough memory.
FactorPtr analyse(const Eigen::SparseMatrix<double>& lower, std::vector<int> permutation,
                  Eigen::Index interior);

}  // namespace anticrack::ddm
