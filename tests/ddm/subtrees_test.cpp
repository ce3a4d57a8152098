// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/multifrontal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "base/at.hpp"

namespace anticrack::ddm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A forest of `count` nodes, about every hundredth a root.
EliminationTree random_forest(int count, unsigned seed) {
  std::minstd_rand random(seed);
  EliminationTree tree{std::vector<int>(at(count), -1), std::vector<double>(at(count))};
  for (int s = 0; s < count; ++s) {
    tree.work[at(s)] = 1 + static_cast<double>(random() % 100);
    const int above = count - 1 - s;
    if (above > 0 && random() % 100 != 0) {
      tree.parent[at(s)] =
          s + 1 + static_cast<int>(random() % static_cast<unsigned>(std::min(above, 9)));
    }
  }
  return tree;
}

TEST(Subtrees, AreWholeAndDisjointAndHaveNoRootOfTheTree) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const int threads : {2, 3, 16}) {
      const EliminationTree tree = random_forest(2000, seed);
      const Subtrees subtrees = part(tree, threads);
      std::size_t inside = 0;
      for (const std::vector<int>& nodes : subtrees.nodes) {
        ASSERT_FALSE(nodes.empty());
        EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
        const int root = nodes.back();
        EXPECT_GE(tree.parent[at(root)], 0);
        for (const int s : nodes) EXPECT_EQ(subtrees.root[at(s)], root);
        inside += nodes.size();
      }
      std::size_t marked = 0;
      for (int s = 0; s < 2000; ++s) {
        const int parent = tree.parent[at(s)], root = subtrees.root[at(s)];
        marked += root >= 0 ? 1 : 0;
        if (root >= 0 && root != s) {
          EXPECT_EQ(subtrees.root[at(parent)], root);
        }
        if (root < 0 && parent >= 0) {
          EXPECT_LT(subtrees.root[at(parent)], 0);
        }
      }
      EXPECT_EQ(marked, inside);
    }
  }
}

/// A complete binary tree of equal nodes: 15, its root last.
TEST(Subtrees, ShareTheWork) {
  const EliminationTree tree{{2, 2, 6, 5, 5, 6, 14, 9, 9, 13, 12, 12, 13, 14, -1},
                             std::vector<double>(15, 1.0)};
  const Subtrees four = part(tree, 1);  // none with more than a quarter of the work
  EXPECT_EQ(four.nodes.size(), 4U);
  for (const std::vector<int>& nodes : four.nodes) EXPECT_EQ(nodes.size(), 3U);
  EXPECT_THAT(four.root, ElementsAre(2, 2, 2, 5, 5, 5, -1, 9, 9, 9, 12, 12, 12, -1, -1));
}

TEST(Subtrees, OfAChainAndOfNothing) {
  EXPECT_THAT(part({{}, {}}, 2).nodes, IsEmpty());
  EXPECT_THAT(part({{-1}, {1}}, 2).nodes, IsEmpty());
  const Subtrees chain = part({{1, 2, 3, -1}, {1, 1, 1, 97}}, 2);
  ASSERT_EQ(chain.nodes.size(), 1U);
  EXPECT_THAT(chain.nodes[0], ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace anticrack::ddm
