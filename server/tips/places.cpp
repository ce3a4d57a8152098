// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/places.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "base/at.hpp"
#include "mesh/refine.hpp"
#include "stop/stop.hpp"

namespace anticrack::tips {
namespace {

using mesh::EdgeEnd;
using mesh::Kind;
using mesh::TipKind;

/// Nodes of a straight piece are this far from it at most, as a fraction of their distance from the
/// tip. Coordinates are known to `rounding`, which decides near the tip.
constexpr double straightness = 1e-9, rounding = 1e-15;
/// Two directions that differ by less are one.
constexpr double same_direction = 1e-6;

double length(const Point& p) { return std::hypot(p[0], p[1]); }

/// What begins at a tip and goes on straight with the same condition.
struct Arm {
  Point direction{};                ///< from the tip, unit
  std::vector<std::int32_t> nodes;  ///< from the tip on
};

/// `size`: the largest coordinate of the mesh.
Arm walk(const mesh::Mesh& mesh, const std::vector<EdgeEnd>& ends, const EdgeEnd& first,
         double size) {
  Arm arm;
  arm.nodes.push_back(first.node);
  const Point tip = position(mesh, first.node), reference = minus(position(mesh, first.other), tip);
  // The angles from the reference in which all nodes so far lie.
  double low = -1, high = 1;
  for (EdgeEnd here = first;;) {
    stop::look_at_turn<stop::quick>(arm.nodes.size(), "following cracks from their tips");
    const Point to = minus(position(mesh, here.other), tip);
    const double far = length(to), slack = straightness + rounding * size / far,
                 angle =
                     std::atan2(reference[0] * to[1] - reference[1] * to[0], dot(reference, to));
    if (angle + slack < low || angle - slack > high) break;
    low = std::max(low, angle - slack);
    high = std::min(high, angle + slack);
    arm.direction = {to[0] / far, to[1] / far};
    arm.nodes.push_back(here.other);
    const auto next = mesh::ends_at(ends, here.other);
    if (next.size() != 2 || here.other == first.node) break;
    const EdgeEnd& on = next[next[0].other == here.node ? 1 : 0];
    if (on.kind != here.kind || on.inclusion != here.inclusion || on.forward != here.forward) break;
    here = on;
  }
  return arm;
}

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

void take_course(const EdgeEnd& behind, const Point& d, Place& place) {
  place.course.ahead = {-d[0], -d[1]};
  place.course.normal = behind.forward ? Point{-d[1], d[0]} : Point{d[1], -d[0]};
}

}  // namespace

std::vector<Place> find_places(const mesh::Mesh& mesh, const mesh::EdgeTable& edges,
                               const std::vector<EdgeEnd>& ends) {
  double size = 0;
  for (const double x : mesh.xy) size = std::max(size, std::abs(x));
  const std::vector<bool> on_boundary = edges.boundary_nodes(mesh.node_count());
  std::set<std::pair<std::int32_t, std::int32_t>> chords;
  for (const mesh::ChordEdge& chord : mesh.chords)
    chords.emplace(std::min(chord.a, chord.b), std::max(chord.a, chord.b));
  std::vector<Place> places;
  for (const std::int32_t node : mesh::tips(mesh, edges, ends)) {
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
    // The last chord is short beside its curve (mesh::Tips), so that hardly a disc is left.
    if (place.reason.empty() && chords.contains(std::minmax(node, behind.other)))
      place.reason = "it lies on a curve, of which the mesh has chords; end it by a straight piece";
    place.unilateral = behind.kind == Kind::crack || behind.kind == Kind::delaminated;
    if (place.reason.empty()) {
      std::vector<Arm> arms{walk(mesh, ends, behind, size)};
      take_course(behind, arms[0].direction, place);
      place.behind.assign(arms[0].nodes.begin() + 1, arms[0].nodes.end());
      if (here.size() == 2) {
        arms.push_back(walk(mesh, ends, here[1 - met.behind], size));
        const Point off = minus(arms[1].direction, place.course.ahead);
        if (length(off) > same_direction)
          place.reason = "the interface bends there, as where chords of a curve meet";
      }
      for (const Arm& arm : arms) {
        take_edges(arm, place);
        place.reach = std::min(place.reach,
                               length(minus(position(mesh, arm.nodes.back()), place.course.tip)));
      }
      std::ranges::sort(place.edges);
    }
    places.push_back(std::move(place));
  }
  return places;
}

}  // namespace anticrack::tips
