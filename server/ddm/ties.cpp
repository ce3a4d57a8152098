// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/cut_steps.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "base/at.hpp"
#include "base/union_find.hpp"
#include "ddm/bodies.hpp"

namespace anticrack::ddm {
namespace {

using mesh::Kind;

/// Sets of tied sides. Their members are the bodies, the nodes of bodies that tilt, and the sides.
/// A body that does not tilt stands for all its nodes.
class Classes {
 public:
  Classes(const mesh::Mesh& mesh, const Sides& sides, const Bodies& bodies)
      : _mesh(mesh),
        _bodies(bodies),
        _rigid(bodies.bodies.size()),
        _at_node(mesh.node_count(), -1) {
    for (const CutEdge& edge : sides.edges)
      if (edge.inclusion >= 0) add_rigid(edge);
    _sets = base::UnionFind(_rigid + sides.sides.size());
    for (const CutEdge& edge : sides.edges) {
      for (std::size_t end = 0; end < 2; ++end)
        if (edge.plus[end] >= 0) tie(edge, end);
    }
  }

  std::int32_t of(std::int32_t side) {
    return _sets.find(static_cast<std::int32_t>(_rigid) + side);
  }
  void unite(std::int32_t a, std::int32_t b) { _sets.unite(a, b); }

  /// Numbers the unknowns: first the motions, then the other sets in the order of their first
  /// sides. Returns the unknown of each side.
  std::vector<std::int32_t> number(std::size_t sides, Skeleton& skeleton) {
    std::vector<std::int32_t> of_class(_rigid + sides, -1), result(sides);
    for (std::size_t b = 0; b < _bodies.bodies.size(); ++b) {
      const Body& body = _bodies.bodies[b];
      of_class[b] = static_cast<std::int32_t>(skeleton.inclusion.size());
      _motion.push_back(of_class[b]);
      skeleton.inclusion.insert(skeleton.inclusion.end(), 1 + body.axes.size(),
                                body.inclusions.front());
    }
    for (std::size_t i = 0; i < sides; ++i) {
      const std::size_t set = at(of(static_cast<std::int32_t>(i)));
      if (of_class[set] < 0) {
        of_class[set] = static_cast<std::int32_t>(skeleton.inclusion.size());
        const bool follows = set < _rigid;
        const std::int32_t body = follows ? _follower[set - _bodies.bodies.size()].body : -1;
        if (follows) _follower[set - _bodies.bodies.size()].unknown = of_class[set];
        skeleton.inclusion.push_back(follows ? _bodies.bodies[at(body)].inclusions.front() : -1);
      }
      result[i] = of_class[set];
    }
    skeleton.unknowns = skeleton.inclusion.size();
    return result;
  }

  /// The number of unknowns that are motions.
  std::size_t motions() const {
    return _motion.empty() ? 0 : at(_motion.back()) + 1 + _bodies.bodies.back().axes.size();
  }

  /// Adds the conditions of nodes that follow motions and of motions that are held, and sets the
  /// motions of each inclusion.
  void move_bodies(LinearConditions& conditions, Skeleton& skeleton) const {
    for (const Follower& one : _follower)
      if (one.unknown >= 0) conditions.follow(one.unknown, value(one.body, position(one.node)));
    for (std::size_t b = 0; b < _bodies.bodies.size(); ++b) {
      const Body& body = _bodies.bodies[b];
      const auto number = static_cast<std::int32_t>(b);
      const std::int32_t inclusion = body.inclusions.front();
      if (body.fixed)
        hold(conditions, skeleton, value(number, body.centre), {inclusion, -1, *body.fixed});
      for (const std::int32_t node : body.on_dirichlet)
        hold(conditions, skeleton, value(number, position(node)), {inclusion, node});
    }
    for (std::size_t j = 0; j < _bodies.of.size(); ++j) {
      const std::int32_t body = _bodies.of[j];
      RigidMotion motion{_bodies.centre[j], value(body, _bodies.centre[j]), {}, {}};
      const std::vector<mesh::Point>& axes = _bodies.bodies[at(body)].axes;
      for (std::size_t k = 0; k < axes.size(); ++k) {
        const std::int32_t unknown = _motion[at(body)] + 1 + static_cast<std::int32_t>(k);
        motion.slope_x.push_back({unknown, axes[k][0]});
        motion.slope_y.push_back({unknown, axes[k][1]});
      }
      skeleton.motions.push_back(std::move(motion));
    }
  }

 private:
  struct Follower {
    std::int32_t body, node;
    std::int32_t unknown = -1;
  };

  mesh::Point position(std::int32_t node) const { return mesh::position(_mesh, node); }

  void add_rigid(const CutEdge& edge) {
    const std::int32_t body = _bodies.of[at(edge.inclusion)];
    for (const std::int32_t node : edge.node) {
      std::int32_t& member = _at_node[at(node)];
      if (member >= 0) continue;
      member = body;
      if (_bodies.bodies[at(body)].axes.empty()) continue;
      member = static_cast<std::int32_t>(_rigid++);
      _follower.push_back({body, node});
    }
  }

  void tie(const CutEdge& edge, std::size_t end) {
    const auto first = static_cast<std::int32_t>(_rigid);
    const std::int32_t minus = first + edge.minus[end], plus = first + edge.plus[end];
    const std::int32_t body = _at_node[at(edge.node[end])];
    if (edge.kind == Kind::glue) _sets.unite(minus, plus);
    if (edge.kind == Kind::inclusion) _sets.unite(minus, body);
    if (edge.inclusion >= 0) _sets.unite(plus, body);
  }

  /// u of a body at a point, as a sum over its motions.
  Terms value(std::int32_t body, const mesh::Point& x) const {
    const Body& of = _bodies.bodies[at(body)];
    Terms terms{{_motion[at(body)], 1}};
    for (std::size_t k = 0; k < of.axes.size(); ++k)
      terms.push_back({_motion[at(body)] + 1 + static_cast<std::int32_t>(k), lever(of, k, x)});
    return terms;
  }

  static void hold(LinearConditions& conditions, Skeleton& skeleton, const Terms& terms,
                   const Held& held) {
    const auto k = static_cast<std::int32_t>(skeleton.held.size());
    skeleton.held.push_back(held);
    if (Terms agreement = conditions.hold(terms, k); !agreement.empty())
      skeleton.agreements.push_back(std::move(agreement));
  }

  const mesh::Mesh& _mesh;
  const Bodies& _bodies;
  std::size_t _rigid;                  // number of members that are bodies or nodes of bodies
  std::vector<std::int32_t> _at_node;  // (nodes) the rigid member there, or -1
  std::vector<Follower> _follower;
  std::vector<std::int32_t> _motion;  // (bodies) unknown that is A; the slopes follow
  base::UnionFind _sets{0};
};

/// A condition w[upper] >= w[lower] between two values of one node.
struct Above {
  std::int32_t upper = 0;
  std::int32_t lower = 0;
  auto operator<=>(const Above&) const = default;
};

/// Whether a chain of conditions leads down from `upper` to `lower` without using `without`.
bool leads(const std::vector<Above>& conditions, std::int32_t upper, std::int32_t lower,
           const Above* without) {
  std::vector<std::int32_t> open = {upper};
  std::set<std::int32_t> seen = {upper};
  while (!open.empty()) {
    const std::int32_t here = open.back();
    open.pop_back();
    if (here == lower) return true;
    const auto first = std::lower_bound(conditions.begin(), conditions.end(), here,
                                        [](const Above& a, std::int32_t u) { return a.upper < u; });
    for (auto it = first; it != conditions.end() && it->upper == here; ++it)
      if ((without == nullptr || *it != *without) && seen.insert(it->lower).second)
        open.push_back(it->lower);
  }
  return false;
}

std::vector<Above> each_once(std::vector<Above> conditions) {
  std::sort(conditions.begin(), conditions.end());
  conditions.erase(std::unique(conditions.begin(), conditions.end()), conditions.end());
  std::erase_if(conditions, [](const Above& a) { return a.upper == a.lower; });
  return conditions;
}

/// The conditions on cycles a >= b >= ... >= a; the values on a cycle are all equal. O(k^2).
std::vector<Above> on_cycles(const std::vector<Above>& conditions) {
  const std::vector<Above> all = each_once(conditions);
  std::vector<Above> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result),
               [&all](const Above& a) { return leads(all, a.lower, a.upper, nullptr); });
  return result;
}

/// Transitive reduction: drops repeated conditions, those of a value with itself, and those that
/// follow from others. The result is sorted, and unique if there are no cycles. O(k^2).
std::vector<Above> without_implied(std::vector<Above> conditions) {
  const std::vector<Above> all = each_once(std::move(conditions));
  std::vector<Above> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result),
               [&all](const Above& a) { return !leads(all, a.upper, a.lower, &a); });
  return result;
}

/// An end of an edge that may open, and the sides there.
struct OpenEnd {
  std::int32_t node, minus, plus;
};

std::vector<OpenEnd> open_ends(const Sides& sides) {
  std::vector<OpenEnd> ends;
  ends.reserve(2 * sides.edges.size());
  for (const CutEdge& edge : sides.edges) {
    if (edge.kind != Kind::crack && edge.kind != Kind::delaminated) continue;
    for (std::size_t end = 0; end < 2; ++end)
      if (edge.plus[end] >= 0)  // not on the Dirichlet boundary
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
/// equal, so their classes are united.
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

/// Numbers the conditions in the order of the couples, so that they follow the cracks. Conditions
/// that depend on earlier ones come last.
void number_contacts(const std::vector<NodeContacts>& nodes, Classes& classes,
                     LinearConditions& conditions, Ties& ties) {
  constexpr std::int32_t unseen = -1;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> number;
  for (const NodeContacts& node : nodes)
    for (const Above& contact : node.above) number[{contact.upper, contact.lower}] = unseen;
  Skeleton& skeleton = ties.skeleton;
  std::vector<Contact> dependent;
  for (Couple& couple : ties.couples) {
    const auto found = number.find({classes.of(couple.plus), classes.of(couple.minus)});
    if (found == number.end()) continue;
    if (found->second == unseen) {
      const Contact contact{ties.unknown[at(couple.plus)], ties.unknown[at(couple.minus)]};
      const auto next = static_cast<std::int32_t>(skeleton.contacts.size());
      if (auto follows = conditions.part(contact.plus, contact.minus, next)) {
        skeleton.dependent.push_back(std::move(*follows));
        dependent.push_back(contact);
        found->second = -1 - static_cast<std::int32_t>(dependent.size());
      } else {
        skeleton.contacts.push_back(contact);
        found->second = next;
      }
    }
    couple.contact = found->second;
  }
  skeleton.independent = skeleton.contacts.size();
  for (Couple& couple : ties.couples)
    if (couple.contact < unseen)
      couple.contact = static_cast<std::int32_t>(skeleton.independent) - 2 - couple.contact;
  skeleton.contacts.insert(skeleton.contacts.end(), dependent.begin(), dependent.end());
}

/// Lists the couples of all edges but free cracks. A free crack makes no couples; its end gets that
/// of another edge between the same sides, if there is one.
void list_couples(const Sides& sides, Ties& ties) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> number;
  ties.of_end.assign(sides.edges.size(), {-1, -1});
  for (const bool free : {false, true}) {
    for (std::size_t e = 0; e < sides.edges.size(); ++e) {
      const CutEdge& edge = sides.edges[e];
      if ((edge.kind == Kind::free) != free) continue;
      for (std::size_t end = 0; end < 2; ++end) {
        if (edge.minus[end] == edge.plus[end])  // a Dirichlet node, or the tip of a slit
          continue;
        const std::pair between{edge.minus[end], edge.plus[end]};
        if (free) {
          if (const auto found = number.find(between); found != number.end())
            ties.of_end[e][end] = found->second;
          continue;
        }
        const auto [entry, is_new] =
            number.try_emplace(between, static_cast<std::int32_t>(ties.couples.size()));
        if (is_new) ties.couples.push_back({edge.minus[end], edge.plus[end], -1});
        ties.of_end[e][end] = entry->second;
      }
    }
  }
}

}  // namespace

Ties tie(const mesh::Mesh& mesh, const Sides& sides) {
  const Bodies bodies = find_bodies(mesh, sides);
  Ties ties;
  list_couples(sides, ties);
  ties.rigid.assign(sides.sides.size(), -1);
  for (const CutEdge& edge : sides.edges) {
    for (const std::int32_t plus : edge.plus)
      if (plus >= 0 && edge.inclusion >= 0) ties.rigid[at(plus)] = edge.inclusion;
  }
  Classes classes(mesh, sides, bodies);
  const std::vector<NodeContacts> contacts = contacts_by_node(sides, classes);
  ties.unknown = classes.number(sides.sides.size(), ties.skeleton);
  LinearConditions conditions(ties.skeleton.unknowns, classes.motions());
  classes.move_bodies(conditions, ties.skeleton);
  number_contacts(contacts, classes, conditions, ties);
  ties.skeleton.rows = conditions.rows(ties.skeleton.free);
  return ties;
}

}  // namespace anticrack::ddm
