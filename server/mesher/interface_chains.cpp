// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import_steps.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "mesher/messages.hpp"

namespace anticrack::mesher {
namespace {

class Walker {
 public:
  Walker(std::span<const InterfaceEdge> edges, const std::vector<bool>& on_boundary)
      : _edges(edges), _on_boundary(on_boundary), _taken(edges.size(), false) {
    // edges are sorted by (low, high), so those of a node are sorted by their other node
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

/// The chain in the opposite direction.
Chain reversed(Chain chain) {
  std::reverse(chain.nodes.begin(), chain.nodes.end());
  std::reverse(chain.edges.begin(), chain.edges.end());
  std::swap(chain.left, chain.right);
  return chain;
}

bool is_glue(const InterfaceEdge* edge) { return edge->meaning.role == CurveRole::glue; }

std::pair<double, double> point(const mesh::Mesh& mesh, std::int32_t node) {
  const auto i = 2 * at(node);
  return {mesh.xy[i], mesh.xy[i + 1]};
}

/// Twice the area inside a closed chain; positive if it runs counterclockwise.
double turning(const mesh::Mesh& mesh, const Chain& chain) {
  const auto [x0, y0] = point(mesh, chain.nodes[0]);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < chain.nodes.size(); ++i) {
    const auto [xa, ya] = point(mesh, chain.nodes[i]);
    const auto [xb, yb] = point(mesh, chain.nodes[i + 1]);
    sum += (xa - x0) * (yb - y0) - (xb - x0) * (ya - y0);
  }
  return sum;
}

/// Whether the chain runs as rule 3 says, by coordinates, so that node numbers do not matter.
bool runs_as_by_rule(const mesh::Mesh& mesh, const Chain& chain) {
  if (chain.left != chain.right) return chain.left > chain.right;
  if (chain.closed()) return turning(mesh, chain) > 0;
  return point(mesh, chain.nodes.front()) < point(mesh, chain.nodes.back());
}

std::string note(const mesh::Mesh& mesh, const Chain& chain, bool lines_differ) {
  const char* why =
      lines_differ ? "the lines on it run both ways" : "no line of the file lies on it";
  if (chain.left != chain.right) {
    return fmt::format(
        "subdomain \"{}\" is taken for its plus side: {}; to choose, call the one on that "
        "side \"plus\", or let all lines run with it on their left",
        mesh.subdomains[at(chain.left)], why);
  }
  return fmt::format(
      "its plus side is taken to be the left, walked from {} to {}: {}; to choose, let "
      "all lines run with the plus side on their left",
      place_of(mesh, chain.nodes[0]), place_of(mesh, chain.nodes[1]), why);
}

enum class Along { forwards, backwards, both, none };

/// The direction of the lines along a chain, without or with those on glue.
Along direction(const Chain& chain, const DirectedLines& lines, bool glue_too) {
  bool forwards = false;
  bool backwards = false;
  for (std::size_t i = 0; i < chain.edges.size(); ++i) {
    if (!glue_too && is_glue(chain.edges[i])) continue;
    forwards |= lines.contains({chain.nodes[i], chain.nodes[i + 1]});
    backwards |= lines.contains({chain.nodes[i + 1], chain.nodes[i]});
  }
  if (forwards && backwards) return Along::both;
  if (forwards) return Along::forwards;
  return backwards ? Along::backwards : Along::none;
}

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

Oriented orient(Chain chain, const mesh::Mesh& mesh, const DirectedLines& lines) {
  const auto name = [&](std::int32_t s) { return mesh.subdomains[at(s)]; };
  const auto is_plus = [&](std::int32_t s, std::int32_t facing) {
    return s != facing && (name(s) == "plus" || name(facing) == "minus");
  };
  if (is_plus(chain.left, chain.right)) return {std::move(chain), ""};
  if (is_plus(chain.right, chain.left)) return {reversed(std::move(chain)), ""};
  Along along = direction(chain, lines, false);
  if (along == Along::none) along = direction(chain, lines, true);
  if (along == Along::forwards) return {std::move(chain), ""};
  if (along == Along::backwards) return {reversed(std::move(chain)), ""};
  if (!runs_as_by_rule(mesh, chain)) chain = reversed(std::move(chain));
  const bool silent = std::all_of(chain.edges.begin(), chain.edges.end(), is_glue);
  std::string told = silent ? "" : note(mesh, chain, along == Along::both);
  return {std::move(chain), std::move(told)};
}

}  // namespace anticrack::mesher
