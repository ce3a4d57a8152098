// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_subdomains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mesh/at.hpp"
#include "mesh/geometry_faces.hpp"
#include "mesh/geometry_intervals.hpp"
#include "mesh/geometry_names.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/union_find.hpp"

namespace anticrack::mesh {
namespace {

using Edges = std::vector<std::array<int, 2>>;

Edges edges_of(const Plan& plan) {
  Edges edges;
  edges.reserve(plan.curves.size());
  for (const PlannedCurve& curve : plan.curves) edges.push_back({curve.a, curve.b});
  return edges;
}

/// The faces of one subdomain as a set: align lines do not separate subdomains.
UnionFind join_faces(const Plan& plan, const Arrangement& arrangement,
                     const std::vector<bool>& used) {
  UnionFind subdomains(arrangement.faces.size());
  for (std::size_t e = 0; e < plan.curves.size(); ++e) {
    if (!used[e] || plan.curves[e].role != Role::align) continue;
    subdomains.unite(arrangement.left[e], arrangement.right[e]);
  }
  return subdomains;
}

/// The curves to keep: all but glue with the same subdomain on both sides.
std::vector<bool> kept_curves(const Plan& plan, const Edges& edges) {
  std::vector<bool> kept(edges.size(), true);
  const Arrangement all = arrange(plan.points, edges, kept);
  UnionFind subdomains = join_faces(plan, all, kept);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const PlannedCurve& curve = plan.curves[e];
    if (curve.role != Role::interface || curve.kind != Kind::glue) continue;
    kept[e] = !subdomains.same(all.left[e], all.right[e]);
  }
  return kept;
}

/// Faces bounded by loops, and the curves inside each that bound no other face.
struct Faces {
  Arrangement loops;
  std::vector<std::vector<int>> embedded;
};

Faces find_faces(const Plan& plan, const Edges& edges, const std::vector<bool>& kept) {
  const Arrangement first = arrange(plan.points, edges, kept);
  std::vector<bool> bounding = kept;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (first.left[e] == first.right[e]) bounding[e] = false;
  Faces faces{arrange(plan.points, edges, bounding), {}};
  Arrangement& loops = faces.loops;
  faces.embedded.resize(loops.faces.size());
  // every face is bounded by curves, which tell its new number
  std::vector<int> now(first.faces.size(), Arrangement::outside);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!bounding[e]) continue;
    if (first.left[e] >= 0) now[at(first.left[e])] = loops.left[e];
    if (first.right[e] >= 0) now[at(first.right[e])] = loops.right[e];
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!kept[e] || bounding[e]) continue;
    const int face = now[at(first.left[e])];
    loops.left[e] = loops.right[e] = face;
    faces.embedded[at(face)].push_back(static_cast<int>(e));
  }
  return faces;
}

/// Faces in the order in which a walk along the interfaces, then along the other curves, meets
/// them, grouped by subdomain.
struct Order {
  std::vector<int> subdomain;  ///< per face: its number
  std::vector<int> faces;      ///< in order
  int count = 0;
};

Order order_faces(const Plan& plan, const Arrangement& loops, const std::vector<bool>& kept) {
  UnionFind subdomains = join_faces(plan, loops, kept);
  Order order;
  const std::size_t n = loops.faces.size();
  order.subdomain.assign(n, -1);
  std::vector<int> number(n, -1);  // of the set of a face
  std::vector<bool> met(n, false);
  const auto meet = [&](int face) {
    if (face < 0 || met[at(face)]) return;
    met[at(face)] = true;
    int& of_set = number[at(subdomains.find(face))];
    if (of_set < 0) of_set = order.count++;
    order.subdomain[at(face)] = of_set;
    order.faces.push_back(face);
  };
  for (const bool interfaces : {true, false}) {
    for (std::size_t e = 0; e < plan.curves.size(); ++e) {
      if (!kept[e] || (plan.curves[e].role == Role::interface) != interfaces) continue;
      meet(loops.right[e]);
      meet(loops.left[e]);
    }
  }
  std::stable_sort(order.faces.begin(), order.faces.end(),
                   [&](int a, int b) { return order.subdomain[at(a)] < order.subdomain[at(b)]; });
  return order;
}

struct Named {
  std::vector<std::string> name;  ///< per subdomain
  std::vector<double> tension;
};

void check_given_tension(double tension, const std::string& field) {
  if (std::isfinite(tension) && tension > 0) return;
  refuse(field, field, " is ", show(tension), "; a tension is a number above 0");
}

Named name_subdomains(const Geometry& geometry, const Network& network, const Plan& plan,
                      const Edges& edges, const std::vector<bool>& kept, const Arrangement& loops,
                      const Order& order) {
  const auto count = at(order.count);
  Named named{std::vector<std::string>(count), std::vector<double>(count, 1)};
  std::vector<std::size_t> owner(count);
  std::vector<std::string> used;
  used.reserve(geometry.regions.size() + count);
  for (std::size_t i = 0; i < geometry.regions.size(); ++i) {
    const RegionSpec& region = geometry.regions[i];
    const std::string field = indexed("regions", i) + ".at";
    check_point(region.at, field);
    check_given_tension(region.tension, indexed("regions", i) + ".tension");
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const Segment s{plan.points[at(edges[e][0])], plan.points[at(edges[e][1])]};
      if (!kept[e] || distance(region.at, s) > network.tolerance) continue;
      refuse(field, field, " ", show(region.at), " lies on ",
             network.lines[at(network.chords[e].line)].field,
             "; it must lie inside the subdomain it names");
    }
    const int face = face_at(loops, plan.points, edges, region.at);
    if (face < 0) {
      refuse(field, field, " ", show(region.at),
             " lies outside the membrane; it must lie inside the subdomain it names");
    }
    const auto subdomain = at(order.subdomain[at(face)]);
    if (!named.name[subdomain].empty()) {
      refuse(field, field, " ", show(region.at), " lies in the subdomain that ",
             indexed("regions", owner[subdomain]), " names already; leave one of them out");
    }
    owner[subdomain] = i;
    named.name[subdomain] = region.name;
    named.tension[subdomain] = region.tension;
    used.push_back(region.name);
  }
  for (std::size_t s = 0; s < count; ++s) {
    if (!named.name[s].empty()) continue;
    named.name[s] = unused_name("omega" + std::to_string(s + 1), used);
  }
  return named;
}

/// Splits what is left of each interface into chains of curves.
void add_chains(const Network& network, const std::vector<std::string>& names,
                const std::vector<bool>& kept, Plan& plan) {
  std::vector<std::vector<std::vector<int>>> chains(names.size());
  for (std::size_t e = 0; e < network.chords.size(); ++e) {
    const auto line = at(network.chords[e].line);
    if (network.lines[line].role != Role::interface || !kept[e]) continue;
    auto& own = chains[line - 1];
    const bool goes_on = !own.empty() && own.back().back() + 1 == static_cast<int>(e);
    if (!goes_on) own.emplace_back();
    own.back().push_back(static_cast<int>(e));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto& own = chains[i];
    const NetworkLine& line = network.lines[i + 1];
    if (own.empty()) {
      refuse(line.field, line.field,
             " separates nothing and carries nothing: the same subdomain lies on both of its "
             "sides; put a crack or an inclusion on it, extend it to the boundary or to another "
             "interface, or make it a line of options.align");
    }
    const auto joined = [&](int before, int after) {
      return plan.curves[at(before)].b == plan.curves[at(after)].a;
    };
    if (line.line.closed() && own.size() > 1 && joined(own.back().back(), own.front().front())) {
      own.back().insert(own.back().end(), own.front().begin(), own.front().end());
      own.erase(own.begin());
    }
    for (auto& chain : own) plan.interfaces.push_back({names[i], std::move(chain)});
  }
  // the first chain of an interface keeps its name; the others get unused ones
  std::vector<std::string> used = names;
  for (std::size_t i = 1; i < plan.interfaces.size(); ++i) {
    if (plan.interfaces[i].name != plan.interfaces[i - 1].name) continue;
    const std::string name = plan.interfaces[i].name;
    for (; i < plan.interfaces.size() && plan.interfaces[i].name == name; ++i)
      plan.interfaces[i].name = unused_name(name, used);
  }
}

/// Removes the curves that are not kept, and the points only they use.
void compact(const std::vector<bool>& kept, Plan& plan) {
  std::vector<std::vector<int>> pieces(plan.curves.size());
  std::vector<int> point_now(plan.points.size(), -1);
  std::vector<PlannedCurve> curves;
  std::vector<Point> points;
  const auto renumber = [&](int& point) {
    int& now = point_now[at(point)];
    if (now < 0) {
      now = static_cast<int>(points.size());
      points.push_back(plan.points[at(point)]);
    }
    point = now;
  };
  for (std::size_t e = 0; e < plan.curves.size(); ++e) {
    if (!kept[e]) continue;
    pieces[e] = {static_cast<int>(curves.size())};
    curves.push_back(plan.curves[e]);
    renumber(curves.back().a);
    renumber(curves.back().b);
  }
  plan.points = std::move(points);
  replace_curves(plan, std::move(curves), pieces);
}

}  // namespace

void lay_subdomains(const Geometry& geometry, const Network& network,
                    const std::vector<std::string>& names, Plan& plan) {
  const Edges edges = edges_of(plan);
  const std::vector<bool> kept = kept_curves(plan, edges);
  add_chains(network, names, kept, plan);
  Faces faces = find_faces(plan, edges, kept);
  const Order order = order_faces(plan, faces.loops, kept);
  const Named named = name_subdomains(geometry, network, plan, edges, kept, faces.loops, order);
  std::vector<int> place(faces.loops.faces.size(), -1);
  plan.faces.reserve(order.faces.size());
  for (const int f : order.faces) {
    const auto face = at(f);
    place[face] = static_cast<int>(plan.faces.size());
    const auto subdomain = at(order.subdomain[face]);
    plan.faces.push_back(
        {named.name[subdomain], named.tension[subdomain], std::move(faces.loops.faces[face].outer),
         std::move(faces.loops.faces[face].holes), std::move(faces.embedded[face])});
  }
  const auto placed = [&](int face) { return face < 0 ? -1 : place[at(face)]; };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    plan.curves[e].left = placed(faces.loops.left[e]);
    plan.curves[e].right = placed(faces.loops.right[e]);
  }
  compact(kept, plan);
}

}  // namespace anticrack::mesh
