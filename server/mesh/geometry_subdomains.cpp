// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_subdomains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "mesh/geometry_faces.hpp"
#include "mesh/geometry_names.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

using Edges = std::vector<std::array<int, 2>>;

Edges edges_of(const Plan& plan) {
  Edges edges;
  edges.reserve(plan.curves.size());
  for (const PlannedCurve& curve : plan.curves) edges.push_back({curve.a, curve.b});
  return edges;
}

/// Faces that belong to one subdomain have one root.
class Subdomains {
 public:
  Subdomains(const Plan& plan, const Arrangement& arrangement, const std::vector<bool>& used)
      : _root(arrangement.faces.size()) {
    std::iota(_root.begin(), _root.end(), 0);
    for (std::size_t e = 0; e < plan.curves.size(); ++e) {
      if (!used[e] || plan.curves[e].role != Role::align) continue;
      _root[static_cast<std::size_t>(of(arrangement.left[e]))] = of(arrangement.right[e]);
    }
  }
  int of(int face) const {
    while (face >= 0 && _root[static_cast<std::size_t>(face)] != face) {
      face = _root[static_cast<std::size_t>(face)];
    }
    return face;
  }

 private:
  std::vector<int> _root;
};

/// The curves that stay: all but glue with one subdomain on both sides.
std::vector<bool> kept_curves(const Plan& plan, const Edges& edges) {
  std::vector<bool> kept(edges.size(), true);
  const Arrangement all = arrange(plan.points, edges, kept);
  const Subdomains subdomains(plan, all, kept);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const PlannedCurve& curve = plan.curves[e];
    if (curve.role != Role::interface || curve.kind != Kind::glue) continue;
    kept[e] = subdomains.of(all.left[e]) != subdomains.of(all.right[e]);
  }
  return kept;
}

/// Faces bounded by loops, and the curves that hang or swim in them.
struct Faces {
  Arrangement loops;
  std::vector<std::vector<int>> embedded;
};

Faces find_faces(const Plan& plan, const Edges& edges, const std::vector<bool>& kept) {
  const Arrangement first = arrange(plan.points, edges, kept);
  std::vector<bool> bounding = kept;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (first.left[e] == first.right[e]) bounding[e] = false;
  }
  Faces faces{arrange(plan.points, edges, bounding), {}};
  Arrangement& loops = faces.loops;
  faces.embedded.resize(loops.faces.size());
  // every face has curves that bound it, so these say what has become of it
  std::vector<int> now(first.faces.size(), Arrangement::outside);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!bounding[e]) continue;
    if (first.left[e] >= 0) now[static_cast<std::size_t>(first.left[e])] = loops.left[e];
    if (first.right[e] >= 0) now[static_cast<std::size_t>(first.right[e])] = loops.right[e];
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!kept[e] || bounding[e]) continue;
    const int face = now[static_cast<std::size_t>(first.left[e])];
    loops.left[e] = loops.right[e] = face;
    faces.embedded[static_cast<std::size_t>(face)].push_back(static_cast<int>(e));
  }
  return faces;
}

/// Faces in the order in which a walk along interfaces, then all curves, meets them: those of one
/// subdomain together.
struct Order {
  std::vector<int> subdomain;  ///< per face: its number
  std::vector<int> faces;      ///< in order
  int count = 0;
};

Order order_faces(const Plan& plan, const Arrangement& loops, const std::vector<bool>& kept) {
  const Subdomains roots(plan, loops, kept);
  Order order;
  const std::size_t n = loops.faces.size();
  order.subdomain.assign(n, -1);
  std::vector<int> number(n, -1);  // of a root
  std::vector<bool> met(n, false);
  const auto meet = [&](int face) {
    if (face < 0 || met[static_cast<std::size_t>(face)]) return;
    met[static_cast<std::size_t>(face)] = true;
    int& of_root = number[static_cast<std::size_t>(roots.of(face))];
    if (of_root < 0) of_root = order.count++;
    order.subdomain[static_cast<std::size_t>(face)] = of_root;
    order.faces.push_back(face);
  };
  for (const bool interfaces : {true, false}) {
    for (std::size_t e = 0; e < plan.curves.size(); ++e) {
      if (!kept[e] || (plan.curves[e].role == Role::interface) != interfaces) continue;
      meet(loops.right[e]);
      meet(loops.left[e]);
    }
  }
  std::stable_sort(order.faces.begin(), order.faces.end(), [&](int a, int b) {
    return order.subdomain[static_cast<std::size_t>(a)] <
           order.subdomain[static_cast<std::size_t>(b)];
  });
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
  const auto count = static_cast<std::size_t>(order.count);
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
      const Segment s{plan.points[static_cast<std::size_t>(edges[e][0])],
                      plan.points[static_cast<std::size_t>(edges[e][1])]};
      if (!kept[e] || distance(region.at, s) > network.tolerance) continue;
      refuse(field, field, " ", show(region.at), " lies on ",
             network.lines[static_cast<std::size_t>(network.chords[e].line)].field,
             "; it must lie inside the subdomain it names");
    }
    const int face = face_at(loops, plan.points, edges, region.at);
    if (face < 0) {
      refuse(field, field, " ", show(region.at),
             " lies outside the membrane; it must lie inside the subdomain it names");
    }
    const auto subdomain =
        static_cast<std::size_t>(order.subdomain[static_cast<std::size_t>(face)]);
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

/// What is left of an interface: chains of its curves.
void add_chains(const Network& network, const std::vector<std::string>& names,
                const std::vector<bool>& kept, Plan& plan) {
  std::vector<std::string> used;
  used.reserve(2 * names.size());
  std::vector<std::vector<std::vector<int>>> chains(names.size());
  for (std::size_t e = 0; e < network.chords.size(); ++e) {
    const auto line = static_cast<std::size_t>(network.chords[e].line);
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
             "sides; put a crack or an inclusion on it, prolong it to the boundary or to another "
             "interface, or make it a line of options.align");
    }
    const auto joined = [&](int before, int after) {
      return plan.curves[static_cast<std::size_t>(before)].b ==
             plan.curves[static_cast<std::size_t>(after)].a;
    };
    if (line.line.closed() && own.size() > 1 && joined(own.back().back(), own.front().front())) {
      own.back().insert(own.back().end(), own.front().begin(), own.front().end());
      own.erase(own.begin());
    }
    for (auto& chain : own) plan.interfaces.push_back({names[i], std::move(chain)});
  }
  // whole interfaces keep their names, pieces take those that are left
  for (const std::string& name : names) used.push_back(name);
  for (std::size_t i = 1; i < plan.interfaces.size(); ++i) {
    if (plan.interfaces[i].name != plan.interfaces[i - 1].name) continue;
    std::size_t k = i;
    for (; k < plan.interfaces.size() && plan.interfaces[k].name == plan.interfaces[i - 1].name;) {
      ++k;
    }
    const std::string name = plan.interfaces[i].name;
    for (std::size_t j = i; j < k; ++j) plan.interfaces[j].name = unused_name(name, used);
    i = k - 1;
  }
}

/// Takes the curves out that are not kept, and the points only they had.
void compact(const std::vector<bool>& kept, Plan& plan) {
  std::vector<int> curve_now(plan.curves.size(), -1);
  std::vector<int> point_now(plan.points.size(), -1);
  std::vector<PlannedCurve> curves;
  std::vector<Point> points;
  curves.reserve(plan.curves.size());
  points.reserve(plan.points.size());
  const auto renumber = [&](int& point) {
    int& now = point_now[static_cast<std::size_t>(point)];
    if (now < 0) {
      now = static_cast<int>(points.size());
      points.push_back(plan.points[static_cast<std::size_t>(point)]);
    }
    point = now;
  };
  for (std::size_t e = 0; e < plan.curves.size(); ++e) {
    if (!kept[e]) continue;
    curve_now[e] = static_cast<int>(curves.size());
    curves.push_back(plan.curves[e]);
    renumber(curves.back().a);
    renumber(curves.back().b);
  }
  const auto renumber_loop = [&](std::vector<int>& loop) {
    for (int& edge : loop) {
      const int now = curve_now[static_cast<std::size_t>(std::abs(edge) - 1)] + 1;
      edge = edge > 0 ? now : -now;
    }
  };
  const auto renumber_curves = [&](std::vector<int>& list) {
    for (int& curve : list) curve = curve_now[static_cast<std::size_t>(curve)];
  };
  for (PlannedInterface& interface : plan.interfaces) renumber_curves(interface.curves);
  for (PlannedFace& face : plan.faces) {
    renumber_loop(face.outer);
    for (auto& hole : face.holes) renumber_loop(hole);
    renumber_curves(face.embedded);
  }
  plan.curves = std::move(curves);
  plan.points = std::move(points);
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
    const auto face = static_cast<std::size_t>(f);
    place[face] = static_cast<int>(plan.faces.size());
    const auto subdomain = static_cast<std::size_t>(order.subdomain[face]);
    plan.faces.push_back(
        {named.name[subdomain], named.tension[subdomain], std::move(faces.loops.faces[face].outer),
         std::move(faces.loops.faces[face].holes), std::move(faces.embedded[face])});
  }
  const auto placed = [&](int face) {
    return face < 0 ? -1 : place[static_cast<std::size_t>(face)];
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    plan.curves[e].left = placed(faces.loops.left[e]);
    plan.curves[e].right = placed(faces.loops.right[e]);
  }
  compact(kept, plan);
}

}  // namespace anticrack::mesh
