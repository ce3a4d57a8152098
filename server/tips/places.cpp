// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/places.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>

#include "base/at.hpp"
#include "mesh/refine.hpp"
#include "stop/stop.hpp"

namespace anticrack::tips {
namespace {

using mesh::TipKind;
using mesh::EdgeEnd;
using mesh::Kind;

/// Nodes of a straight piece are this far from it at most, as a fraction of their distance from the
/// tip. Coordinates are known to `rounding`, which decides near the tip.
constexpr double straightness = 1e-9, rounding = 1e-15;
/// Two directions that differ by less are one.
constexpr double same_direction = 1e-6;

double length(const Point& p) { return std::hypot(p[0], p[1]); }

/// What begins at a tip and goes on with the same condition.
struct Arm {
  Point direction{};     ///< from the tip, unit
  Point centre{};        ///< of its arc
  double radius = 0;     ///< 0: straight
  std::string fault;     ///< why it is neither straight nor an arc
  std::vector<std::int32_t> nodes;  ///< from the tip on
};

class Walker {
 public:
  Walker(const mesh::Mesh& mesh, const std::vector<EdgeEnd>& ends) : _mesh(mesh), _ends(ends) {
    for (const mesh::BentEdge& edge : mesh.bent) _bent.push_back(&edge);
    std::ranges::sort(_bent, {}, [](const mesh::BentEdge* e) { return key(e->a, e->b); });
    for (const double x : mesh.xy) _size = std::max(_size, std::abs(x));
  }

  Arm walk(const EdgeEnd& first) const {
    Arm arm;
    arm.nodes.push_back(first.node);
    const mesh::BentEdge* const bent = bent_edge(first);
    if (bent != nullptr) {
      const mesh::Bend& bend = _mesh.bends[at(bent->bend)];
      if (bend.radius == 0) arm.fault = "it lies on a curve that is neither straight nor an arc";
      const bool from_a = bent->a == first.node;
      const Point d = bend.derivative(from_a ? bent->from : bent->to);
      const double sign = (bent->to > bent->from) == from_a ? 1 / length(d) : -1 / length(d);
      arm.direction = {sign * d[0], sign * d[1]};
      arm.centre = bend.centre;
      arm.radius = bend.radius;
    }
    const Point tip = position(_mesh, first.node);
    // Directions in which all nodes so far lie: from a reference, in radians.
    const Point reference = bent != nullptr ? arm.direction : towards(tip, first.other);
    double low = -1, high = 1;
    for (EdgeEnd here = first;;) {
      stop::look_at_turn<stop::quick>(arm.nodes.size(), "following cracks from their tips");
      if (bent == nullptr) {
        const Point to = minus(position(_mesh, here.other), tip);
        const double far = length(to), slack = straightness + rounding * _size / far,
                     angle = std::atan2(reference[0] * to[1] - reference[1] * to[0],
                                        dot(reference, to));
        if (bent_edge(here) != nullptr || angle + slack < low || angle - slack > high) break;
        low = std::max(low, angle - slack);
        high = std::min(high, angle + slack);
        arm.direction = {to[0] / far, to[1] / far};
      } else if (!on_arc(here, arm)) {
        break;
      }
      arm.nodes.push_back(here.other);
      const auto next = mesh::ends_at(_ends, here.other);
      if (next.size() != 2 || here.other == first.node) break;
      const EdgeEnd& on = next[next[0].other == here.node ? 1 : 0];
      if (on.kind != here.kind || on.inclusion != here.inclusion) break;
      here = on;
    }
    return arm;
  }

 private:
  static std::array<std::int32_t, 2> key(std::int32_t a, std::int32_t b) {
    return {std::min(a, b), std::max(a, b)};
  }
  const mesh::BentEdge* bent_edge(const EdgeEnd& end) const {
    const auto wanted = key(end.node, end.other);
    const auto found = std::ranges::lower_bound(
        _bent, wanted, {}, [](const mesh::BentEdge* e) { return key(e->a, e->b); });
    return found != _bent.end() && key((*found)->a, (*found)->b) == wanted ? *found : nullptr;
  }
  Point towards(const Point& tip, std::int32_t node) const {
    const Point to = minus(position(_mesh, node), tip);
    const double far = length(to);
    return {to[0] / far, to[1] / far};
  }
  bool on_arc(const EdgeEnd& edge, const Arm& arm) const {
    const mesh::BentEdge* const bent = bent_edge(edge);
    if (bent == nullptr) return false;
    const mesh::Bend& bend = _mesh.bends[at(bent->bend)];
    return length(minus(bend.centre, arm.centre)) + std::abs(bend.radius - arm.radius) <=
           straightness * _size;
  }

  const mesh::Mesh& _mesh;
  const std::vector<EdgeEnd>& _ends;
  std::vector<const mesh::BentEdge*> _bent;
  double _size = 0;  ///< the largest coordinate
};

bool is_crack(Kind kind) { return kind == Kind::crack || kind == Kind::free; }

/// The kind of a tip by the conditions that meet there, and which of them lies behind it.
struct Met {
  TipKind kind = TipKind::other;
  std::size_t behind = 0;
  std::string reason{};
};

Met meet(std::span<const EdgeEnd> ends) {
  if (ends.size() > 2) return {TipKind::other, 0, "more than two parts of interfaces meet there"};
  if (ends.size() == 2) {
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const EdgeEnd &one = ends[i], &other = ends[1 - i];
      if (one.kind == Kind::delaminated && other.kind == Kind::inclusion &&
          one.inclusion == other.inclusion)
        return {TipKind::front, i};
      if (other.kind == Kind::glue) {
        const Met alone = meet({&one, 1});
        return {alone.kind, i, alone.reason};
      }
    }
    return {TipKind::other, 0, "two conditions meet there that are not an end or a front"};
  }
  const Kind kind = ends[0].kind;
  if (is_crack(kind)) return {TipKind::crack_tip};
  return {kind == Kind::delaminated ? TipKind::delaminated_end : TipKind::bonded_end};
}

void take_edges(const Arm& arm, Place& place) {
  for (std::size_t i = 0; i + 1 < arm.nodes.size(); ++i)
    place.edges.push_back(
        {std::min(arm.nodes[i], arm.nodes[i + 1]), std::max(arm.nodes[i], arm.nodes[i + 1])});
}

std::string take_course(const EdgeEnd& behind, const Arm& arm, const Arm* ahead, Place& place) {
  const Point d = arm.direction;
  place.course.ahead = {-d[0], -d[1]};
  place.course.normal = behind.forward ? Point{-d[1], d[0]} : Point{d[1], -d[0]};
  if (!arm.fault.empty()) return arm.fault;
  if (arm.radius > 0) {
    const double side = dot(minus(arm.centre, place.course.tip), place.course.normal);
    place.course.radius = side > 0 ? arm.radius : -arm.radius;
  }
  if (ahead == nullptr) return "";
  if (!ahead->fault.empty()) return ahead->fault;
  const Point e = ahead->direction;
  if (std::hypot(d[0] + e[0], d[1] + e[1]) > same_direction) return "the interface bends there";
  if (arm.radius != ahead->radius ||
      (arm.radius > 0 &&
       length(minus(arm.centre, ahead->centre)) > straightness * length(arm.centre) + rounding))
    return "the curvature of the interface changes there";
  return "";
}

}  // namespace

std::vector<Place> find_places(const mesh::Mesh& mesh, const mesh::EdgeTable& edges,
                               const std::vector<EdgeEnd>& ends) {
  const Walker walker(mesh, ends);
  const std::vector<bool> on_boundary = edges.boundary_nodes(mesh.node_count());
  std::vector<Place> places;
  for (const std::int32_t node : mesh::tips(mesh)) {
    const auto here = mesh::ends_at(ends, node);
    const Met met = meet(here);
    const EdgeEnd& behind = here[met.behind];
    Place place;
    place.node = node;
    place.course.tip = position(mesh, node);
    place.interface = behind.interface;
    place.inclusion = behind.inclusion;
    place.kind = met.kind;
    for (const mesh::EdgeUse& use : edges.find(node, behind.other)) {
      // A triangle is on the left of its edges, and so is the plus side of the chain.
      const bool plus = (use.from == node) == behind.forward;
      place.subdomain[plus ? 1 : 0] = mesh.subdomain[at(use.triangle)];
    }
    place.reason = on_boundary[at(node)] ? "it lies on the boundary" : met.reason;
    place.unilateral = behind.kind == Kind::crack || behind.kind == Kind::delaminated;
    if (place.reason.empty()) {
      const Arm arm = walker.walk(behind);
      std::optional<Arm> ahead;
      if (here.size() == 2) ahead = walker.walk(here[1 - met.behind]);
      place.reason = take_course(behind, arm, ahead ? &*ahead : nullptr, place);
      place.behind.assign(arm.nodes.begin() + 1, arm.nodes.end());
      for (const Arm* one : std::initializer_list<const Arm*>{&arm, ahead ? &*ahead : nullptr}) {
        if (one == nullptr) continue;
        take_edges(*one, place);
        place.reach = std::min(
            place.reach, length(minus(position(mesh, one->nodes.back()), place.course.tip)));
      }
      std::ranges::sort(place.edges);
    }
    places.push_back(std::move(place));
  }
  return places;
}

}  // namespace anticrack::tips
