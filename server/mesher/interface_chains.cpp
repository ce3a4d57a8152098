// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/interface_chains.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace anticrack::mesher {
namespace {

class Walker {
 public:
  Walker(std::span<const InterfaceEdge> edges, const std::vector<bool>& on_boundary)
      : _edges(edges), _on_boundary(on_boundary), _taken(edges.size(), false) {
    // edges come by (low, high), so those of a node come by their other node
    for (std::size_t i = 0; i < edges.size(); ++i) {
      _at[edges[i].from].push_back(i);
      _at[edges[i].to].push_back(i);
    }
  }

  std::vector<Chain> chains() {
    std::vector<Chain> found;
    for (const auto& [node, incident] : _at) {
      if (!ends_at(node)) continue;
      for (const std::size_t first : incident)
        if (!_taken[first]) found.push_back(walk(node, first));
    }
    for (std::size_t i = 0; i < _edges.size(); ++i)
      if (!_taken[i]) found.push_back(walk(std::min(_edges[i].from, _edges[i].to), i));
    return found;
  }

 private:
  bool ends_at(std::int32_t node) const {
    return _at.at(node).size() != 2 || _on_boundary[at(node)];
  }

  Chain walk(std::int32_t node, std::size_t next) {
    Chain chain;
    chain.nodes.push_back(node);
    const std::int32_t start = node;
    for (;;) {
      const InterfaceEdge& edge = _edges[next];
      const bool forwards = edge.from == node;
      if (chain.edges.empty()) {
        chain.left = forwards ? edge.left : edge.right;
        chain.right = forwards ? edge.right : edge.left;
      }
      _taken[next] = true;
      chain.edges.push_back(&edge);
      node = forwards ? edge.to : edge.from;
      chain.nodes.push_back(node);
      if (node == start || ends_at(node)) return chain;
      const auto& both = _at.at(node);
      next = both[0] == next ? both[1] : both[0];
    }
  }

  std::span<const InterfaceEdge> _edges;
  const std::vector<bool>& _on_boundary;
  std::vector<bool> _taken;
  std::map<std::int32_t, std::vector<std::size_t>> _at;
};

}  // namespace

std::vector<Chain> build_chains(std::span<const InterfaceEdge> edges,
                                const std::vector<bool>& on_boundary) {
  std::vector<Chain> chains = Walker(edges, on_boundary).chains();
  const auto key = [](const Chain& chain) {
    return std::tuple(std::min(chain.left, chain.right), std::max(chain.left, chain.right),
                      chain.nodes[0], chain.nodes[1]);
  };
  std::sort(chains.begin(), chains.end(),
            [&](const Chain& a, const Chain& b) { return key(a) < key(b); });
  return chains;
}

Chain reversed(Chain chain) {
  std::reverse(chain.nodes.begin(), chain.nodes.end());
  std::reverse(chain.edges.begin(), chain.edges.end());
  std::swap(chain.left, chain.right);
  return chain;
}

}  // namespace anticrack::mesher
