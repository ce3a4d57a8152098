// SPDX-License-Identifier: GPL-3.0-or-later
//
// Elimination of a subdomain's interior by the multifrontal method: each supernode has a dense
// matrix, the front. BLAS-3 eliminates its own columns; the remainder is added to the parent's
// front.
//
// I. Duff and J. Reid, The multifrontal solution of indefinite sparse symmetric linear equations,
// ACM Trans. Math. Softw. 9 (1983); J. Liu, The multifrontal method for sparse matrix solution,
// SIAM Rev. 34 (1992).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "ddm/kernels.hpp"

namespace anticrack::ddm {

/// With K = [K_II K_IG; K_GI K_GG], I the first pattern.columns unknowns and P a permutation of I:
///
///   P K_II P' = L_II L_II',   L_GI = K_GI P' L_II'^-1,   S = K_GG - L_GI L_GI'
///
/// K_GG is not factorised, so S is accurate also where K is singular.
/// `pattern`: of L from CHOLMOD's analysis, children first; the pattern of each supernode must
/// contain those of its children, and its values are not read. `place`: (n) position of each
/// unknown in P. `stiffness`: K, lower triangle. `values`: receives L_II and L_GI, zero above the
/// diagonal. `schur`: receives S, (n_G,n_G). Returns false if K_II is not positive definite to
/// rounding. Throws errors::Error (internal) for an invalid pattern. Independent subtrees run on
/// `threads` threads; the bits do not depend on their number. Memory: the updates that wait for
/// their parent, O(n) for planar graphs with nested dissection, and 12 bytes for each entry of K.
bool eliminate_interior(const Supernodes& pattern, std::span<const int> place,
                        const Eigen::SparseMatrix<double>& stiffness, double* values,
                        Eigen::MatrixXd& schur, int threads);

/// For a front [A .; B C] with `columns` columns of A and `panel` = [A; B], column-major with
/// `height` rows: A = LL', A <- L, B <- B L'^-1, and in the lower triangle update <- -BB', or with
/// `add` update <- update - BB'. Returns false if A is not positive definite to rounding.
bool eliminate_front(int columns, int height, double* panel, double* update, bool add = false);

// Subtrees that threads eliminate independently.

/// Nodes in an order that has children before their parents; index base 0.
struct EliminationTree {
  std::vector<int> parent;   ///< -1: none
  std::vector<double> work;  ///< operations of the node alone
};

/// Disjoint subtrees; the nodes above them belong to none.
struct Subtrees {
  std::vector<std::vector<int>> nodes;  ///< of each subtree, increasing; the most work first
  std::vector<int> root;                ///< root of the subtree that a node is in; -1: none
};

/// Subtrees to share among `threads` threads; each is a small fraction of the work, so that they
/// balance. No subtree contains a root of the tree. O(n log n).
Subtrees part(const EliminationTree& tree, int threads);

}  // namespace anticrack::ddm
