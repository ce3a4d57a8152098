// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace anticrack::ddm {

/// Nodes in an order that has children before their parents; index base 0.
struct EliminationTree {
  std::vector<int> parent;   ///< -1: none
  std::vector<double> work;  ///< of the node alone
};

/// Disjoint subtrees; the nodes above them belong to none.
struct Subtrees {
  std::vector<std::vector<int>> nodes;  ///< of each subtree, increasing; the most work first
  std::vector<int> root;                ///< of the subtree of each node; -1: none
};

/// Subtrees to balance over `threads` threads: each a small enough fraction of the work. None
/// contains a root of the tree. O(n log n).
Subtrees part(const EliminationTree& tree, int threads);

}  // namespace anticrack::ddm
