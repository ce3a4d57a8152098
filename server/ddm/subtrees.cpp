// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/multifrontal.hpp"

#include <algorithm>
#include <queue>
#include <utility>

#include "base/at.hpp"

namespace anticrack::ddm {

Subtrees part(const EliminationTree& tree, int threads) {
  constexpr double subtrees_a_thread = 4;
  const int count = static_cast<int>(tree.parent.size());
  std::vector<double> work = tree.work;  // work of the whole subtree of each node
  std::vector<std::vector<int>> children(at(count));
  double all = 0;
  std::priority_queue<std::pair<double, int>> candidates;
  const auto descend = [&](int node) {
    for (const int child : children[at(node)]) candidates.push({work[at(child)], child});
  };
  for (int s = 0; s < count; ++s) {
    all += tree.work[at(s)];
    if (const int parent = tree.parent[at(s)]; parent >= 0) {
      work[at(parent)] += work[at(s)];
      children[at(parent)].push_back(s);
    } else {
      descend(s);
    }
  }
  const double most = all / (subtrees_a_thread * threads);
  while (!candidates.empty() && candidates.top().first > most) {
    const int node = candidates.top().second;
    candidates.pop();
    descend(node);
  }
  Subtrees result{{}, std::vector<int>(at(count), -1)};
  std::vector<int> place(at(count), -1);  // index in result.nodes of each node's subtree
  for (; !candidates.empty(); candidates.pop()) {
    const int root = candidates.top().second;
    result.root[at(root)] = root;
    place[at(root)] = static_cast<int>(result.nodes.size());
    result.nodes.emplace_back();
  }
  for (int s = count; s-- > 0;) {
    const int parent = tree.parent[at(s)];
    if (result.root[at(s)] < 0 && parent >= 0 && result.root[at(parent)] >= 0) {
      result.root[at(s)] = result.root[at(parent)];
      place[at(s)] = place[at(parent)];
    }
    if (place[at(s)] >= 0) result.nodes[at(place[at(s)])].push_back(s);
  }
  for (std::vector<int>& nodes : result.nodes) std::reverse(nodes.begin(), nodes.end());
  return result;
}

}  // namespace anticrack::ddm
