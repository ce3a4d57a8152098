// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace anticrack::ddm {

/// Nodes in an order that has children before their parents; index base 0.
struct EliminationTree {
  std::vector<int> parent;   ///< -1: none
  std::vector<double> work;  ///< of the node alone
};

/// Disjoint subtrees; what lies above them is of none.
struct Subtrees {
  std::vector<std::vector<int>> nodes;  ///< of each subtree, increasing; the most work first
  std::vector<int> root;                ///< of the subtree of each node; -1: none
};

/// Subtrees that `threads` threads can share: each a part of the whole work small enough that none
/// waits long for the last. No root of the tree is in one. O(n log n).
Subtrees part(const EliminationTree& tree, int threads);

}  // namespace anticrack::ddm
