// SPDX-License-Identifier: GPL-3.0-or-later
//
// Elimination of a subdomain's interior by the multifrontal method: a dense matrix, the front, for
// each supernode, whose own columns are eliminated with BLAS-3 and whose rest is added to the front
// of its parent.
//
// I. Duff and J. Reid, The multifrontal solution of indefinite sparse symmetric linear equations,
// ACM Trans. Math. Softw. 9 (1983); J. Liu, The multifrontal method for sparse matrix solution,
// SIAM Rev. 34 (1992).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>

#include "ddm/forward_solve.hpp"

namespace anticrack::ddm {

/// With K = [K_II K_IG; K_GI K_GG], I the first pattern.columns unknowns and P a permutation of I:
///
///   P K_II P' = L_II L_II',   L_GI = K_GI P' L_II'^-1,   S = K_GG - L_GI L_GI'
///
/// K_GG is not factorised, so S is as exact as the elimination is, also where K is singular.
/// `pattern`: of L, its supernodes children first, each pattern with those of its children in it
/// (CHOLMOD's analysis); its values are not read. `place`: of each unknown in P, (n).
/// `stiffness`: K, of which the lower triangle is read. `values`: of L_II and L_GI, where the
/// pattern says, not initialised; zero above the diagonal. `schur`: S, (n_G,n_G), overwritten.
/// Returns false where K_II is not positive definite to rounding. Throws errors::Error (internal)
/// for another pattern. Independent subtrees of the elimination tree go on `threads` threads at
/// once; the same bits for the same input, whatever their number. Memory: that of the fronts that
/// wait for their parent, O(n) for planar graphs cut by nested dissection, and 12 bytes an entry of
/// K.
bool eliminate_interior(const Supernodes& pattern, std::span<const int> place,
                        const Eigen::SparseMatrix<double>& stiffness, double* values,
                        Eigen::MatrixXd& schur, int threads);

/// Of a front [A .; B C], A its first `columns`, `panel` being [A; B], column-major with `height`
/// rows: A = LL', B <- B L'^-1, `update` = -BB', or with `add` update <- update - BB', its lower
/// triangle; A is replaced by L. False where A is not positive definite to rounding.
bool eliminate_front(int columns, int height, double* panel, double* update, bool add = false);

}  // namespace anticrack::ddm
