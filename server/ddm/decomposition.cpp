// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/decomposition.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

#include "errors/errors.hpp"

namespace anticrack::ddm {
namespace {

using errors::Reason;
using mesh::Kind;
using Edge = std::pair<std::int32_t, std::int32_t>;

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

std::string place(const mesh::Mesh& mesh, std::int32_t node) {
  std::ostringstream text;
  text << "(" << mesh.xy[2 * at(node)] << ", " << mesh.xy[2 * at(node) + 1] << ")";
  return text.str();
}

/// The couple of subdomains that face each other across a node, minus side first.
struct Facing {
  std::int32_t node, minus, plus;
  auto operator<=>(const Facing&) const = default;
};

/// What the edges of one facing say about the node.
struct Conditions {
  bool glue = false, crack = false, bonded = false, delaminated = false;
  std::int32_t inclusion = -1;
  std::int32_t pair = -1;  ///< number, in order of appearance
};

struct SidedEdge {
  std::int32_t a = 0, b = 0, minus = -1, plus = -1;
  Kind kind = Kind::glue;
  std::int32_t inclusion = -1;
};

/// Finds the triangles on both sides of every interface edge; the plus side is on the left of a-b.
std::vector<std::vector<SidedEdge>> find_sides(const mesh::Mesh& mesh) {
  std::map<Edge, SidedEdge*> by_direction;
  std::vector<std::vector<SidedEdge>> chains(mesh.interfaces.size());
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const mesh::Interface& interface = mesh.interfaces[c];
    for (std::size_t e = 0; e < interface.kind.size(); ++e) {
      chains[c].push_back({interface.nodes[e], interface.nodes[e + 1], -1, -1, interface.kind[e],
                           interface.inclusion[e]});
    }
    for (SidedEdge& edge : chains[c]) {
      by_direction[{edge.a, edge.b}] = &edge;
    }
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.triangles[3 * t + k], b = mesh.triangles[3 * t + (k + 1) % 3];
      if (const auto left = by_direction.find({a, b}); left != by_direction.end()) {
        left->second->plus = mesh.subdomain[t];
      }
      if (const auto right = by_direction.find({b, a}); right != by_direction.end()) {
        right->second->minus = mesh.subdomain[t];
      }
    }
  }
  for (const auto& chain : chains) {
    for (const SidedEdge& edge : chain) {
      if (edge.minus < 0 || edge.plus < 0 || edge.minus == edge.plus) {
        throw errors::Error(Reason::mesh_invalid,
                            "the interface edge from " + place(mesh, edge.a) + " to " +
                                place(mesh, edge.b) +
                                " does not lie between two different subdomains");
      }
    }
  }
  return chains;
}

class Cutter {
 public:
  explicit Cutter(const mesh::Mesh& mesh)
      : _mesh(mesh), _chains(find_sides(mesh)), _is_dirichlet(mesh.node_count(), 0) {
    for (const auto& edge : mesh.dirichlet) {
      _is_dirichlet[at(edge[0])] = _is_dirichlet[at(edge[1])] = 1;
    }
  }

  Decomposition run() {
    collect_conditions();
    number_pairs();
    for (std::size_t s = 0; s < _mesh.subdomains.size(); ++s) {
      number_subdomain(static_cast<std::int32_t>(s));
    }
    place_pairs();
    for (Subdomain& subdomain : _result.subdomains) {
      require_supported(subdomain);
    }
    return std::move(_result);
  }

 private:
  void collect_conditions() {
    _result.inclusion_subdomain.assign(_mesh.inclusions.size(), -1);
    std::vector<std::int32_t> inclusion_at(_mesh.node_count(), -1);
    for (const auto& chain : _chains) {
      for (const SidedEdge& edge : chain) {
        if (edge.inclusion >= 0) {
          claim_inclusion(edge, inclusion_at);
        }
        for (const std::int32_t node : {edge.a, edge.b}) {
          add_condition(edge, node);
        }
      }
    }
    for (std::size_t j = 0; j < _mesh.inclusions.size(); ++j) {
      if (_result.inclusion_subdomain[j] < 0) {
        throw errors::Error(Reason::mesh_invalid, "the inclusion \"" + _mesh.inclusions[j] +
                                                      "\" has no edge on any interface");
      }
    }
    refuse_cross_points();
  }

  void claim_inclusion(const SidedEdge& edge, std::vector<std::int32_t>& inclusion_at) {
    std::int32_t& owner = _result.inclusion_subdomain[at(edge.inclusion)];
    if (owner >= 0 && owner != edge.plus) {
      throw errors::Error(
          Reason::not_implemented,
          "the plus side of the inclusion \"" + _mesh.inclusions[at(edge.inclusion)] +
              "\" lies in two subdomains (\"" + _mesh.subdomains[at(owner)] + "\" and, at " +
              place(_mesh, edge.a) + ", \"" + _mesh.subdomains[at(edge.plus)] +
              "\"); turn the interface, or join the subdomains");
    }
    owner = edge.plus;
    for (const std::int32_t node : {edge.a, edge.b}) {
      std::int32_t& other = inclusion_at[at(node)];
      if (other >= 0 && other != edge.inclusion) {
        throw errors::Error(Reason::not_implemented,
                            "the inclusions \"" + _mesh.inclusions[at(other)] + "\" and \"" +
                                _mesh.inclusions[at(edge.inclusion)] + "\" share the node at " +
                                place(_mesh, node) +
                                "; make them one inclusion, or leave an edge between them");
      }
      other = edge.inclusion;
    }
  }

  void add_condition(const SidedEdge& edge, std::int32_t node) {
    if (_is_dirichlet[at(node)] != 0) {
      if (edge.kind != Kind::glue) {
        throw errors::Error(Reason::not_implemented,
                            "a crack or inclusion touches the Dirichlet boundary at " +
                                place(_mesh, node) + "; let it end inside, an edge away from it");
      }
      return;
    }
    Conditions& conditions = _conditions[{node, edge.minus, edge.plus}];
    conditions.glue |= edge.kind == Kind::glue;
    conditions.crack |= edge.kind == Kind::crack;
    conditions.bonded |= edge.kind == Kind::inclusion;
    conditions.delaminated |= edge.kind == Kind::delaminated;
    conditions.inclusion = std::max(conditions.inclusion, edge.inclusion);
  }

  /// Two facings of one node are neighbours in the map.
  void refuse_cross_points() const {
    for (auto it = _conditions.begin(); it != _conditions.end(); ++it) {
      const auto next = std::next(it);
      if (next == _conditions.end() || next->first.node != it->first.node) {
        continue;
      }
      for (const Conditions& conditions : {it->second, next->second}) {
        if (conditions.crack || conditions.bonded || conditions.delaminated) {
          throw errors::Error(Reason::not_implemented,
                              "a crack or inclusion reaches the point " +
                                  place(_mesh, it->first.node) +
                                  " where interfaces meet; let it end an edge before, or give "
                                  "the interfaces that continue it one direction");
        }
      }
    }
  }

  void number_pairs() {
    std::int32_t count = 0;
    _result.interface_pairs.resize(_chains.size());
    for (std::size_t c = 0; c < _chains.size(); ++c) {
      std::vector<std::int32_t>& of_node = _result.interface_pairs[c];
      for (std::size_t e = 0; e < _chains[c].size(); ++e) {
        const SidedEdge& edge = _chains[c][e];
        fem::MassEdge mass{{-1, -1}, length(edge)};
        for (std::size_t end = 0; end < 2; ++end) {
          const std::int32_t node = end == 0 ? edge.a : edge.b;
          if (_is_dirichlet[at(node)] == 0) {
            Conditions& conditions = _conditions[{node, edge.minus, edge.plus}];
            if (conditions.pair < 0) {
              conditions.pair = count++;
            }
            mass.node[end] = conditions.pair;
          }
        }
        if (e == 0) {
          of_node.push_back(mass.node[0]);
        }
        of_node.push_back(mass.node[1]);
        _result.edges.push_back(mass);
      }
    }
    _result.pairs.resize(at(count));
  }

  double length(const SidedEdge& edge) const {
    return std::hypot(_mesh.xy[2 * at(edge.b)] - _mesh.xy[2 * at(edge.a)],
                      _mesh.xy[2 * at(edge.b) + 1] - _mesh.xy[2 * at(edge.a) + 1]);
  }

  /// Trace nodes in the order of the pairs, so that they follow the interfaces.
  std::vector<std::int32_t> trace_nodes(std::int32_t subdomain) const {
    std::vector<std::pair<std::int32_t, std::int32_t>> by_pair;
    for (const auto& [facing, conditions] : _conditions) {
      if (facing.minus == subdomain || facing.plus == subdomain) {
        by_pair.emplace_back(conditions.pair, facing.node);
      }
    }
    std::sort(by_pair.begin(), by_pair.end());
    std::vector<std::int32_t> nodes;
    std::vector<char> seen(_mesh.node_count(), 0);
    for (const auto& [pair, node] : by_pair) {
      if (seen[at(node)] == 0) {
        seen[at(node)] = 1;
        nodes.push_back(node);
      }
    }
    return nodes;
  }

  void number_subdomain(std::int32_t s) {
    Subdomain subdomain;
    subdomain.name = _mesh.subdomains[at(s)];
    std::vector<std::int32_t> used;
    for (std::size_t t = 0; t < _mesh.triangle_count(); ++t) {
      if (_mesh.subdomain[t] == s) {
        used.insert(used.end(), &_mesh.triangles[3 * t], &_mesh.triangles[3 * t] + 3);
      }
    }
    std::vector<std::int32_t> nodes = used;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());

    const std::vector<std::int32_t> trace = trace_nodes(s);
    std::vector<char> on_trace(_mesh.node_count(), 0);
    for (const std::int32_t node : trace) {
      on_trace[at(node)] = 1;
    }
    std::vector<std::int32_t> dirichlet;
    for (const std::int32_t node : nodes) {
      if (_is_dirichlet[at(node)] != 0) {
        dirichlet.push_back(node);
      } else if (on_trace[at(node)] == 0) {
        subdomain.node.push_back(node);
      }
    }
    subdomain.interior = subdomain.node.size();
    subdomain.trace = trace.size();
    subdomain.dirichlet = dirichlet.size();
    subdomain.rigid.assign(trace.size(), -1);
    subdomain.node.insert(subdomain.node.end(), trace.begin(), trace.end());
    subdomain.node.insert(subdomain.node.end(), dirichlet.begin(), dirichlet.end());

    std::vector<std::int32_t> local(_mesh.node_count(), -1);
    for (std::size_t i = 0; i < subdomain.node.size(); ++i) {
      const std::int32_t node = subdomain.node[i];
      local[at(node)] = static_cast<std::int32_t>(i);
      subdomain.part.xy.push_back(_mesh.xy[2 * at(node)]);
      subdomain.part.xy.push_back(_mesh.xy[2 * at(node) + 1]);
    }
    subdomain.part.triangles.reserve(used.size());
    for (const std::int32_t node : used) {
      subdomain.part.triangles.push_back(local[at(node)]);
    }
    _result.subdomains.push_back(std::move(subdomain));
  }

  /// Local trace numbers of the nodes of one subdomain.
  static std::map<std::int32_t, std::int32_t> trace_numbers(const Subdomain& subdomain) {
    std::map<std::int32_t, std::int32_t> numbers;
    for (std::size_t i = 0; i < subdomain.trace; ++i) {
      numbers[subdomain.node[subdomain.interior + i]] = static_cast<std::int32_t>(i);
    }
    return numbers;
  }

  void place_pairs() {
    std::vector<std::map<std::int32_t, std::int32_t>> numbers;
    for (const Subdomain& subdomain : _result.subdomains) {
      numbers.push_back(trace_numbers(subdomain));
    }
    for (const auto& [facing, conditions] : _conditions) {
      NodePair& pair = _result.pairs[at(conditions.pair)];
      pair.node = facing.node;
      pair.minus = facing.minus;
      pair.minus_trace = numbers[at(facing.minus)].at(facing.node);
      pair.plus = facing.plus;
      pair.plus_trace = numbers[at(facing.plus)].at(facing.node);
      pair.inclusion = conditions.inclusion;
      const bool tied = conditions.glue || conditions.bonded;
      if (conditions.inclusion >= 0) {
        pair.kind = tied ? Kind::inclusion : Kind::delaminated;
        _result.subdomains[at(pair.plus)].rigid[at(pair.plus_trace)] = conditions.inclusion;
      } else {
        pair.kind = tied ? Kind::glue : Kind::crack;
      }
    }
  }

  /// Every connected part of a subdomain needs a Dirichlet node, or its stiffness is singular.
  static void require_supported(const Subdomain& subdomain) {
    std::vector<std::int32_t> parent(subdomain.node.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&parent](std::int32_t i) {
      while (parent[at(i)] != i) {
        i = parent[at(i)] = parent[at(parent[at(i)])];
      }
      return i;
    };
    for (std::size_t t = 0; t < subdomain.part.triangle_count(); ++t) {
      const std::int32_t* corner = &subdomain.part.triangles[3 * t];
      parent[at(root(corner[1]))] = root(corner[0]);
      parent[at(root(corner[2]))] = root(corner[0]);
    }
    std::vector<char> supported(subdomain.node.size(), 0);
    for (std::size_t i = subdomain.free(); i < subdomain.node.size(); ++i) {
      supported[at(root(static_cast<std::int32_t>(i)))] = 1;
    }
    for (std::size_t i = 0; i < subdomain.free(); ++i) {
      if (supported[at(root(static_cast<std::int32_t>(i)))] == 0) {
        std::ostringstream message;
        message << "the subdomain \"" << subdomain.name
                << "\" has a part without Dirichlet nodes (around (" << subdomain.part.xy[2 * i]
                << ", " << subdomain.part.xy[2 * i + 1]
                << ")), so it could move as a whole; this version cannot solve that: hold a part "
                   "of its "
                   "boundary, or join it to a neighbour";
        throw errors::Error(Reason::numerical, message.str()).with("subdomain", subdomain.name);
      }
    }
  }

  const mesh::Mesh& _mesh;
  std::vector<std::vector<SidedEdge>> _chains;
  std::vector<char> _is_dirichlet;
  std::map<Facing, Conditions> _conditions;
  Decomposition _result;
};

}  // namespace

Decomposition cut(const mesh::Mesh& mesh) {
  return Cutter(mesh).run();
}

}  // namespace anticrack::ddm
