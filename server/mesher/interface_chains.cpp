// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/interface_chains.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "errors/errors.hpp"
#include "mesher/curve_groups.hpp"

namespace anticrack::mesher {
namespace {

/// An edge walked with subdomain `left` on its left.
struct SideEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  std::int32_t left = 0;
  bool taken = false;
};

using Pair = std::pair<std::int32_t, std::int32_t>;

[[noreturn]] void refuse(const mesh::Mesh& mesh, const Pair& pair, const std::string& what,
                         std::int32_t node, const std::string& cure) {
  const auto name = [&](std::int32_t s) {
    return "\"" + mesh.subdomains[static_cast<std::size_t>(s)] + "\"";
  };
  throw errors::Error(errors::Reason::mesh_invalid, "the interface between surfaces " +
                                                        name(pair.first) + " and " +
                                                        name(pair.second) + " " + what + " at " +
                                                        place_of(mesh, node) + "; " + cure);
}

/// Edges of one pair of subdomains, by node.
class Walker {
 public:
  Walker(const mesh::Mesh& mesh, const Pair& pair, std::vector<SideEdge> edges)
      : _mesh(mesh), _pair(pair), _edges(std::move(edges)) {
    for (std::size_t i = 0; i < _edges.size(); ++i) {
      _at[_edges[i].from].push_back(i);
      _at[_edges[i].to].push_back(i);
    }
    for (const auto& [node, incident] : _at) {
      if (incident.size() > 2) {
        refuse(_mesh, _pair, "branches", node, "let it be a line without branches");
      }
    }
  }

  std::vector<Chain> chains() {
    std::vector<Chain> found;
    for (const auto& [node, incident] : _at) {
      if (incident.size() == 1 && !_edges[incident[0]].taken) found.push_back(walk(node));
    }
    for (const SideEdge& edge : _edges) {
      if (!edge.taken) {
        refuse(
            _mesh, _pair, "closes to a ring", edge.from,
            "an inner surface is not supported: let the interface run from boundary to boundary");
      }
    }
    return found;
  }

 private:
  Chain walk(std::int32_t node) {
    Chain chain;
    chain.nodes.push_back(node);
    for (SideEdge* edge = next(node); edge != nullptr; edge = next(node)) {
      edge->taken = true;
      const bool forwards = edge->from == node;
      const std::int32_t other = edge->left == _pair.first ? _pair.second : _pair.first;
      const std::int32_t left = forwards ? edge->left : other;
      if (chain.nodes.size() == 1) {
        chain.left = left;
        chain.right = left == _pair.first ? _pair.second : _pair.first;
      } else if (chain.left != left) {
        refuse(_mesh, _pair, "changes sides", node, "let the surfaces not meet in a point there");
      }
      node = forwards ? edge->to : edge->from;
      chain.nodes.push_back(node);
    }
    return chain;
  }

  SideEdge* next(std::int32_t node) {
    for (const std::size_t i : _at.at(node)) {
      if (!_edges[i].taken) return &_edges[i];
    }
    return nullptr;
  }

  const mesh::Mesh& _mesh;
  Pair _pair;
  std::vector<SideEdge> _edges;
  std::map<std::int32_t, std::vector<std::size_t>> _at;
};

}  // namespace

std::vector<Chain> build_chains(const mesh::Mesh& mesh, const mesh::EdgeTable& edges) {
  std::map<Pair, std::vector<SideEdge>> by_pair;
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    if (uses.size() != 2) return;
    const std::int32_t s = mesh.subdomain[static_cast<std::size_t>(uses[0].triangle)];
    const std::int32_t other = mesh.subdomain[static_cast<std::size_t>(uses[1].triangle)];
    if (s == other) return;
    // counterclockwise triangles lie on the left of their edges
    by_pair[{std::min(s, other), std::max(s, other)}].push_back({uses[0].from, uses[0].to, s});
  });
  std::vector<Chain> chains;
  for (auto& [pair, list] : by_pair) {
    for (Chain& chain : Walker(mesh, pair, std::move(list)).chains()) {
      chains.push_back(std::move(chain));
    }
  }
  return chains;
}

Chain reversed(Chain chain) {
  std::reverse(chain.nodes.begin(), chain.nodes.end());
  std::swap(chain.left, chain.right);
  return chain;
}

}  // namespace anticrack::mesher
