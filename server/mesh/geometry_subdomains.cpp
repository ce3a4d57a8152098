// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_steps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "base/union_find.hpp"
#include "mesh/geometry_faces.hpp"
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

/// The curves of the outlines of regions, and the side of each on which the inside lies.
struct Outlines {
  std::vector<int> region;                   ///< per curve; -1: not of an outline
  std::vector<bool> inside;                  ///< per region: whether the inside is on the left
  std::vector<std::vector<Point>> polygons;  ///< per region; empty: no outline
};

Outlines find_outlines(const Drawn& geometry, const Network& network, const Plan& plan) {
  std::vector<int> of_line(network.lines.size(), -1);
  for (std::size_t i = 0; i < geometry.regions.size(); ++i) {
    const int line = geometry.region_lines[i];
    if (line >= 0) of_line[network.boundary + at(line)] = static_cast<int>(i);
  }
  Outlines outlines{{}, std::vector<bool>(geometry.regions.size()), {}};
  outlines.region.reserve(plan.curves.size());
  for (const Chord& chord : network.chords) outlines.region.push_back(of_line[at(chord.line)]);
  outlines.polygons.resize(geometry.regions.size());
  for (std::size_t e = 0; e < plan.curves.size(); ++e)
    if (outlines.region[e] >= 0)
      outlines.polygons[at(outlines.region[e])].push_back(plan.points[at(plan.curves[e].a)]);
  for (std::size_t i = 0; i < outlines.polygons.size(); ++i)
    outlines.inside[i] = signed_area(outlines.polygons[i]) > 0;
  return outlines;
}

int inner_face(const Outlines& outlines, const Arrangement& arrangement, std::size_t curve) {
  const bool left = outlines.inside[at(outlines.region[curve])];
  return (left ? arrangement.left : arrangement.right)[curve];
}

/// Joins the faces of each subdomain to a set: align lines do not separate subdomains, nor do
/// cracks and inclusions within the outline of a region.
base::UnionFind join_faces(const Plan& plan, const Outlines& outlines,
                           const Arrangement& arrangement, const std::vector<bool>& used) {
  base::UnionFind subdomains(arrangement.faces.size());
  std::vector<bool> inside(arrangement.faces.size(), false);
  for (std::size_t e = 0; e < plan.curves.size(); ++e) {
    if (!used[e]) continue;
    if (outlines.region[e] >= 0) inside[at(inner_face(outlines, arrangement, e))] = true;
    if (plan.curves[e].role == Role::align)
      subdomains.unite(arrangement.left[e], arrangement.right[e]);
  }
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t e = 0; e < plan.curves.size(); ++e) {
      const PlannedCurve& curve = plan.curves[e];
      const bool parts = curve.role == Role::interface && curve.kind == Kind::glue;
      if (!used[e] || parts || outlines.region[e] >= 0) continue;
      const int left = arrangement.left[e], right = arrangement.right[e];
      if (left < 0 || right < 0 || !(inside[at(left)] || inside[at(right)])) continue;
      grown = grown || !(inside[at(left)] && inside[at(right)]);
      inside[at(left)] = inside[at(right)] = true;
      subdomains.unite(left, right);
    }
  }
  return subdomains;
}

/// The curves to keep: all but glue with the same subdomain on both sides.
std::vector<bool> kept_curves(const Plan& plan, const Outlines& outlines, const Edges& edges) {
  std::vector<bool> kept(edges.size(), true);
  const Arrangement all = arrange(plan.points, edges, kept);
  base::UnionFind subdomains = join_faces(plan, outlines, all, kept);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const PlannedCurve& curve = plan.curves[e];
    if (curve.role != Role::interface || curve.kind != Kind::glue) continue;
    kept[e] = !subdomains.same(all.left[e], all.right[e]);
  }
  return kept;
}

/// Faces with their loops, and the curves inside each face that bound no other face.
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
  // every face has curves on its boundary, which tell its new number
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

Order order_faces(const Plan& plan, const Outlines& outlines, const Arrangement& loops,
                  const std::vector<bool>& kept) {
  base::UnionFind subdomains = join_faces(plan, outlines, loops, kept);
  Order order;
  const std::size_t n = loops.faces.size();
  order.subdomain.assign(n, -1);
  std::vector<int> number(n, -1);  // per set of faces: the number of its subdomain
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
  std::vector<TensionLaw> law;
};

void check_given_tension(double tension, const Field& field) {
  if (std::isfinite(tension) && tension > 0) return;
  refuse(field, field, " is ", shown(tension), "; a tension is a number above 0");
}

void check_law(const RegionSpec& region, const Field& field) {
  if (!region.tension_law) return;
  const std::string fault = fault_of(*region.tension_law);
  if (!fault.empty()) refuse(field, field, ": ", fault);
  if (region.tension != 1)
    refuse(field, field, " and a tension of ", shown(region.tension), " are given; leave one out");
}

/// The subdomain around the point of a region.
int subdomain_at(const RegionSpec& region, const Field& field, const Network& network,
                 const Plan& plan, const Edges& edges, const std::vector<bool>& kept,
                 const Arrangement& loops, const Order& order) {
  check_point(region.at, field);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Segment s{plan.points[at(edges[e][0])], plan.points[at(edges[e][1])]};
    if (!kept[e] || !boxes_meet(s, {region.at, region.at}, network.tolerance)) continue;
    if (distance(region.at, s) > network.tolerance) continue;
    refuse(field, field, " ", shown(region.at), " lies on ",
           network.lines[at(network.chords[e].line)].field,
           "; it must lie inside the subdomain it names");
  }
  const int face = face_at(loops, plan.points, edges, region.at);
  if (face >= 0 && order.subdomain[at(face)] >= 0) return order.subdomain[at(face)];
  refuse(field, field, " ", shown(region.at),
         " lies outside the membrane; it must lie inside the subdomain it names");
}

/// The one subdomain within the outline of a region.
int subdomain_within(int region, const Field& field, const Outlines& outlines,
                     const Network& network, const Arrangement& loops, const Order& order) {
  int subdomain = -1;
  const auto side = [&](int face) { return face < 0 ? -1 : order.subdomain[at(face)]; };
  for (std::size_t e = 0; e < outlines.region.size(); ++e) {
    if (outlines.region[e] != region) continue;
    const int own = order.subdomain[at(inner_face(outlines, loops, e))];
    if (subdomain < 0) subdomain = own;
    if (own == subdomain) continue;
    // the line that parts these two
    for (std::size_t c = 0; c < outlines.region.size(); ++c) {
      const std::pair sides = std::minmax({side(loops.left[c]), side(loops.right[c])});
      if (outlines.region[c] == region || sides != std::minmax({own, subdomain})) continue;
      refuse(field, field, ", at ", shown(network.points[at(network.chords[e].a)]),
             ", is crossed by ", network.lines[at(network.chords[c].line)].field,
             outlines.region[c] < 0
                 ? ", which divides it into several subdomains; end the interface at the outline, "
                   "or make a region of each part"
                 : "; draw them apart, or one inside the other");
    }
  }
  return subdomain;
}

Field field_of(const std::vector<RegionSpec>& regions, std::size_t i) {
  return {"region", i, regions[i].name};
}

/// For each region, the smallest region whose outline is around it; -1: none.
std::vector<int> regions_around(const Outlines& outlines) {
  const auto& polygons = outlines.polygons;
  std::vector<double> area;
  for (const std::vector<Point>& polygon : polygons) area.push_back(std::abs(signed_area(polygon)));
  std::vector<int> around(polygons.size(), -1);
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    for (std::size_t j = 0; j < polygons.size(); ++j) {
      if (polygons[i].empty() || !(area[j] > area[i])) continue;
      if (around[i] >= 0 && area[at(around[i])] < area[j]) continue;
      // the outlines do not cross, but may touch in a point
      const auto own = std::ranges::find_if(polygons[i], [&](const Point& p) {
        return std::ranges::find(polygons[j], p) == polygons[j].end();
      });
      if (own != polygons[i].end() && inside(*own, polygons[j])) around[i] = static_cast<int>(j);
    }
  }
  return around;
}

/// Notes the regions that are cut out of another one, as users may take them for parts of it.
void note_nested(const std::vector<RegionSpec>& regions, const Outlines& outlines,
                 std::vector<std::string>& warnings) {
  constexpr std::size_t most_listed = 3;
  std::vector<std::vector<std::size_t>> within(regions.size());
  const std::vector<int> around = regions_around(outlines);
  for (std::size_t i = 0; i < around.size(); ++i)
    if (around[i] >= 0) within[at(around[i])].push_back(i);
  for (std::size_t j = 0; j < within.size(); ++j) {
    if (within[j].empty()) continue;
    const std::size_t listed = std::min(within[j].size(), most_listed);
    std::string inner;
    for (std::size_t k = 0; k < listed; ++k)
      inner += (k == 0 ? "" : ", ") + field_of(regions, within[j][k]).shown;
    if (within[j].size() > listed) inner += fmt::format(" and {} more", within[j].size() - listed);
    const std::string outer = field_of(regions, j).shown;
    warnings.push_back(inner + (within[j].size() == 1 ? " lies" : " lie") + " inside " + outer +
                       ", cut out of it: the tension and the loads of " + outer +
                       " do not act there, so give each its own");
  }
}

/// Names the subdomains and sets their tension; the plan gets a warning if a tension is not given.
Named name_subdomains(const Drawn& geometry, const Network& network, const Outlines& outlines,
                      const Edges& edges, const std::vector<bool>& kept, const Arrangement& loops,
                      const Order& order, Plan& plan) {
  const auto count = at(order.count);
  const bool any_tension = std::ranges::any_of(geometry.regions, [](const RegionSpec& region) {
    return region.tension != 1 || region.tension_law;
  });
  Named named{std::vector<std::string>(count), std::vector<double>(count, 1),
              std::vector<TensionLaw>(count)};
  std::vector<std::size_t> owner(count);
  std::vector<std::string> used;
  used.reserve(geometry.regions.size() + count);
  for (std::size_t i = 0; i < geometry.regions.size(); ++i) {
    const RegionSpec& region = geometry.regions[i];
    const Field own = field_of(geometry.regions, i);
    const Field field = region.outline ? own.at(".outline", "") : own + ".at";
    check_given_tension(region.tension, own + ".tension");
    check_law(region, own.at(".tension_law", "tension"));
    const auto subdomain =
        at(region.outline
               ? subdomain_within(static_cast<int>(i), field, outlines, network, loops, order)
               : subdomain_at(region, field, network, plan, edges, kept, loops, order));
    if (!named.name[subdomain].empty()) {
      refuse(field, field, region.outline ? " holds" : " " + shown(region.at) + " lies in",
             " the subdomain that ", field_of(geometry.regions, owner[subdomain]),
             " names already; leave one of them out");
    }
    owner[subdomain] = i;
    named.name[subdomain] = region.name;
    named.tension[subdomain] = region.tension;
    named.law[subdomain] = region.tension_law.value_or(TensionLaw());
    used.push_back(region.name);
  }
  note_nested(geometry.regions, outlines, plan.warnings);
  for (std::size_t s = 0; s < count; ++s) {
    if (!named.name[s].empty()) continue;
    named.name[s] = unused_name(fmt::format("omega{}", s + 1), used);
    if (any_tension) {
      plan.warnings.push_back("no region names the subdomain " + named.name[s] +
                              ", so its tension is 1; a region with a point of it as `at` gives it "
                              "another");
    }
  }
  return named;
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

void lay_subdomains(const Drawn& geometry, const Network& network,
                    const std::vector<std::string>& names, const std::vector<Walk>& walks,
                    Plan& plan) {
  const Edges edges = edges_of(plan);
  const Outlines outlines = find_outlines(geometry, network, plan);
  const std::vector<bool> kept = kept_curves(plan, outlines, edges);
  add_chains(network, names, kept, walks, plan);
  Faces faces = find_faces(plan, edges, kept);
  // the boundary has the membrane on its left: what is inside a hole is outside
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (at(network.chords[e].line) < network.boundary) faces.loops.right[e] = Arrangement::outside;
  const Order order = order_faces(plan, outlines, faces.loops, kept);
  const Named named =
      name_subdomains(geometry, network, outlines, edges, kept, faces.loops, order, plan);
  std::vector<int> place(faces.loops.faces.size(), -1);
  plan.faces.reserve(order.faces.size());
  for (const int f : order.faces) {
    const auto face = at(f);
    place[face] = static_cast<int>(plan.faces.size());
    const auto subdomain = at(order.subdomain[face]);
    plan.faces.push_back({named.name[subdomain], named.tension[subdomain], named.law[subdomain],
                          std::move(faces.loops.faces[face].outer),
                          std::move(faces.loops.faces[face].holes),
                          std::move(faces.embedded[face])});
  }
  const auto placed = [&](int face) { return face < 0 ? -1 : place[at(face)]; };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    plan.curves[e].left = placed(faces.loops.left[e]);
    plan.curves[e].right = placed(faces.loops.right[e]);
  }
  turn_chains(walks, plan);
  compact(kept, plan);
}

}  // namespace anticrack::mesh
