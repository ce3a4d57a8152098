// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/ties.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "ddm/order.hpp"
#include "errors/errors.hpp"
#include "mesh/at.hpp"
#include "mesh/union_find.hpp"

namespace anticrack::ddm {
namespace {

using errors::Error;
using errors::Reason;
using mesh::Kind;

void refuse_crack_on_dirichlet(const mesh::Mesh& mesh, const Sides& sides) {
  for (const CutEdge& edge : sides.edges) {
    for (const std::int32_t node : edge.node) {
      if (edge.kind != Kind::glue && sides.on_dirichlet[at(node)] != 0) {
        throw Error(Reason::not_implemented,
                    "a crack or inclusion touches the Dirichlet boundary at " + place(mesh, node) +
                        "; let it end inside, an edge away from it");
      }
    }
  }
}

void refuse_shared_inclusion_nodes(const mesh::Mesh& mesh, const Sides& sides) {
  std::vector<std::int32_t> owner(mesh.node_count(), -1);
  std::vector<char> found(mesh.inclusions.size(), 0);
  for (const CutEdge& edge : sides.edges) {
    if (edge.inclusion < 0) continue;
    found[at(edge.inclusion)] = 1;
    for (const std::int32_t node : edge.node) {
      std::int32_t& other = owner[at(node)];
      if (other >= 0 && other != edge.inclusion) {
        throw Error(Reason::not_implemented,
                    "the inclusions \"" + mesh.inclusions[at(other)] + "\" and \"" +
                        mesh.inclusions[at(edge.inclusion)] + "\" share the node at " +
                        place(mesh, node) + ", which would make them one rigid body" +
                        "; make them one inclusion, or leave an edge between them");
      }
      other = edge.inclusion;
    }
  }
  for (std::size_t j = 0; j < found.size(); ++j) {
    if (found[j] == 0) {
      throw Error(Reason::mesh_invalid,
                  "the inclusion \"" + mesh.inclusions[j] + "\" has no edge on any interface");
    }
  }
}

/// The sets of tied sides: the A_j are members 0..J-1, side i is member J + i.
class Classes {
 public:
  Classes(const mesh::Mesh& mesh, const Sides& sides)
      : _inclusions(static_cast<std::int32_t>(mesh.inclusions.size())),
        _sets(mesh.inclusions.size() + sides.sides.size()) {
    for (const CutEdge& edge : sides.edges) {
      for (std::size_t end = 0; end < 2; ++end)
        if (edge.plus[end] >= 0) tie(edge, end);
    }
  }

  std::int32_t of(std::int32_t side) { return _sets.find(_inclusions + side); }
  void unite(std::int32_t a, std::int32_t b) { _sets.unite(a, b); }

  /// The A_j first, then the other sets in the order of their first sides.
  std::vector<std::int32_t> number(std::size_t sides, std::size_t& unknowns) {
    std::vector<std::int32_t> of_class(at(_inclusions) + sides, -1), result(sides);
    std::int32_t count = 0;
    for (; count < _inclusions; ++count) of_class[at(count)] = count;
    for (std::size_t i = 0; i < sides; ++i) {
      std::int32_t& unknown = of_class[at(of(static_cast<std::int32_t>(i)))];
      if (unknown < 0) unknown = count++;
      result[i] = unknown;
    }
    unknowns = at(count);
    return result;
  }

 private:
  void tie(const CutEdge& edge, std::size_t end) {
    const std::int32_t minus = _inclusions + edge.minus[end], plus = _inclusions + edge.plus[end];
    if (edge.kind == Kind::glue) _sets.unite(minus, plus);
    if (edge.kind == Kind::inclusion) _sets.unite(minus, edge.inclusion);
    if (edge.inclusion >= 0) _sets.unite(plus, edge.inclusion);
  }

  std::int32_t _inclusions;
  mesh::UnionFind _sets;
};

/// Every end of an edge that may open, those of one node next to one another.
struct OpenEnd {
  std::int32_t node, minus, plus;
};

std::vector<OpenEnd> open_ends(const Sides& sides) {
  std::vector<OpenEnd> ends;
  ends.reserve(2 * sides.edges.size());
  for (const CutEdge& edge : sides.edges) {
    if (edge.kind == Kind::crack || edge.kind == Kind::delaminated)
      for (std::size_t end = 0; end < 2; ++end)
        ends.push_back({edge.node[end], edge.minus[end], edge.plus[end]});
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const OpenEnd& a, const OpenEnd& b) { return a.node < b.node; });
  return ends;
}

struct NodeContacts {
  std::int32_t node;
  std::vector<Above> above;
};

/// The conditions that remain between the classes of each node. Values on a cycle of conditions are
/// equal: their classes are united.
std::vector<NodeContacts> contacts_by_node(const Sides& sides, Classes& classes) {
  const std::vector<OpenEnd> ends = open_ends(sides);
  std::vector<NodeContacts> result;
  for (std::size_t begin = 0, end = 0; begin < ends.size(); begin = end) {
    std::vector<Above> above;
    for (; end < ends.size() && ends[end].node == ends[begin].node; ++end)
      above.push_back({classes.of(ends[end].plus), classes.of(ends[end].minus)});
    for (const Above& equal : on_cycles(above)) classes.unite(equal.upper, equal.lower);
    above.clear();
    above.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i)
      above.push_back({classes.of(ends[i].plus), classes.of(ends[i].minus)});
    above = without_implied(std::move(above));
    if (!above.empty()) result.push_back({ends[begin].node, std::move(above)});
  }
  return result;
}

/// Contacts in the order of the couples, so that they follow the cracks.
void number_contacts(const mesh::Mesh& mesh, const std::vector<NodeContacts>& nodes,
                     Classes& classes, Ties& ties) {
  mesh::UnionFind trees(mesh.inclusions.size() + ties.unknown.size());
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> number;
  for (const NodeContacts& node : nodes) {
    for (const Above& contact : node.above) {
      if (!trees.unite(contact.upper, contact.lower)) {
        throw Error(Reason::not_implemented,
                    "the cracks that cross at " + place(mesh, node.node) +
                        " have contact conditions that depend on each other; let one of them end "
                        "an edge before the other");
      }
      number[{contact.upper, contact.lower}] = -1;
    }
  }
  for (Couple& couple : ties.couples) {
    const auto found = number.find({classes.of(couple.plus), classes.of(couple.minus)});
    if (found == number.end()) continue;
    if (found->second < 0) {
      found->second = static_cast<std::int32_t>(ties.skeleton.contacts.size());
      ties.skeleton.contacts.push_back(
          {ties.unknown[at(couple.plus)], ties.unknown[at(couple.minus)]});
    }
    couple.contact = found->second;
  }
}

void list_couples(const Sides& sides, Ties& ties) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> number;
  ties.of_end.assign(sides.edges.size(), {-1, -1});
  for (std::size_t e = 0; e < sides.edges.size(); ++e) {
    const CutEdge& edge = sides.edges[e];
    for (std::size_t end = 0; end < 2; ++end) {
      if (edge.minus[end] == edge.plus[end])  // a Dirichlet node, or the tip of a slit
        continue;
      const auto [entry, is_new] = number.try_emplace(
          {edge.minus[end], edge.plus[end]}, static_cast<std::int32_t>(ties.couples.size()));
      if (is_new) ties.couples.push_back({edge.minus[end], edge.plus[end], -1});
      ties.of_end[e][end] = entry->second;
    }
  }
}

}  // namespace

Ties tie(const mesh::Mesh& mesh, const Sides& sides) {
  refuse_crack_on_dirichlet(mesh, sides);
  refuse_shared_inclusion_nodes(mesh, sides);
  Ties ties;
  list_couples(sides, ties);
  ties.rigid.assign(sides.sides.size(), -1);
  for (const CutEdge& edge : sides.edges) {
    for (const std::int32_t plus : edge.plus)
      if (plus >= 0 && edge.inclusion >= 0) ties.rigid[at(plus)] = edge.inclusion;
  }
  Classes classes(mesh, sides);
  const std::vector<NodeContacts> contacts = contacts_by_node(sides, classes);
  ties.unknown = classes.number(sides.sides.size(), ties.skeleton.unknowns);
  number_contacts(mesh, contacts, classes, ties);
  return ties;
}

}  // namespace anticrack::ddm
