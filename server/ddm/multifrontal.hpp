// SPDX-License-Identifier: GPL-3.0-or-later
//
// Elimination of a subdomain's interior by the multifrontal method: each supernode has a dense
// matrix, the front; its own columns are eliminated by BLAS-3, the rest is added to the front of
// its parent.
//
// I. Duff and J. Reid, The multifrontal solution of indefinite sparse symmetric linear equations,
// ACM Trans. Math. Softw. 9 (1983); J. Liu, The multifrontal method for sparse matrix solution,
// SIAM Rev. 34 (1992).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>

#include "ddm/substitution.hpp"

namespace anticrack::ddm {

/// With K = [K_II K_IG; K_GI K_GG], I the first pattern.columns unknowns and P a permutation of I:
///
///   P K_II P' = L_II L_II',   L_GI = K_GI P' L_II'^-1,   S = K_GG - L_GI L_GI'
///
/// K_GG is not factorised, so S is accurate also where K is singular.
/// `pattern`: of L from CHOLMOD's analysis, children first, each supernode's pattern containing
/// those of its children; its values are not read. `place`: (n) position of each unknown in P.
/// `stiffness`: K, lower triangle. `values`: of L_II and L_GI, not initialised; zero above the
/// diagonal. `schur`: S, (n_G,n_G), overwritten. False if K_II is not positive definite to
/// rounding. Throws errors::Error (internal) for an invalid pattern. Independent subtrees run on
/// `threads` threads; the bits do not depend on their number. Memory: the fronts waiting for their
/// parent, O(n) for planar graphs with nested dissection, and 12 bytes an entry of K.
bool eliminate_interior(const Supernodes& pattern, std::span<const int> place,
                        const Eigen::SparseMatrix<double>& stiffness, double* values,
                        Eigen::MatrixXd& schur, int threads);

/// For a front [A .; B C] with `columns` columns of A and `panel` = [A; B], column-major with
/// `height` rows: A = LL', A <- L, B <- B L'^-1, and the lower triangle of `update` = -BB', or with
/// `add` update
/// <- update - BB'. False if A is not positive definite to rounding.
bool eliminate_front(int columns, int height, double* panel, double* update, bool add = false);

}  // namespace anticrack::ddm
