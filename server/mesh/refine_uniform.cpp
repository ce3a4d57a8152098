// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refine_uniform.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/edges.hpp"
#include "mesh/geometry_primitives.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesh {
namespace {

constexpr const char* halving = "halving a mesh";

/// The midpoints of all edges; their numbers follow those of the base's nodes.
class EdgeMidpoints {
 public:
  EdgeMidpoints(const Mesh& base, std::vector<double>& xy)
      : _base(base), _xy(xy), _edges(base.triangles), _of_side(base.triangles.size()) {
    _edges.each([&](std::span<const EdgeUse> uses) {
      const auto node = static_cast<std::int32_t>(xy.size() / 2);
      stop::look_at_turn<stop::quick>(at(node), halving);
      const Point a = position(base, uses[0].from);
      const Point b = position(base, uses[0].to);
      xy.push_back(0.5 * (a[0] + b[0]));
      xy.push_back(0.5 * (a[1] + b[1]));
      for (const EdgeUse& use : uses) _of_side[side(use)] = node;
    });
  }

  /// The midpoint of the side from corner i of a triangle to the next.
  std::int32_t operator()(std::size_t triangle, std::size_t i) const {
    return _of_side[3 * triangle + i];
  }
  std::int32_t between(std::int32_t a, std::int32_t b) const {
    return _of_side[side(_edges.find(a, b)[0])];
  }

  /// The four parts of a triangle, each counterclockwise.
  std::array<std::array<std::int32_t, 3>, 4> parts(std::size_t triangle) const {
    const std::int32_t* corner = &_base.triangles[3 * triangle];
    const std::int32_t ab = (*this)(triangle, 0), bc = (*this)(triangle, 1),
                       ca = (*this)(triangle, 2);
    return {std::array{corner[0], ab, ca}, std::array{ab, corner[1], bc},
            std::array{ca, bc, corner[2]}, std::array{ab, bc, ca}};
  }

  /// Moves the midpoints of chords onto their bends, where triangles keep their shape. Returns the
  /// halves of all bent edges; those whose midpoints were not moved remain parts of a chord.
  std::vector<BentEdge> bend() {
    std::vector<BentEdge> halves, bent = _base.bent;
    std::erase_if(bent, [](const BentEdge& edge) { return edge.chord > 0; });
    for (const BentEdge& edge : bent) put(edge, _base.bends[at(edge.bend)].at(edge.middle()));
    // where one goes back, a triangle beside it may lose what another needs: until none goes back
    while (std::erase_if(bent, [this](const BentEdge& edge) { return put_back(edge); }) > 0) {
    }
    halves.reserve(2 * _base.bent.size());
    auto moved = bent.begin();
    for (const BentEdge& edge : _base.bent) {
      const std::int32_t node = between(edge.a, edge.b);
      BentEdge first = edge, second = edge;
      if (moved != bent.end() && *moved == edge)
        ++moved;
      else if (edge.chord == 0)
        first.chord = second.chord = distance(position(_base, edge.a), position(_base, edge.b));
      first.b = second.a = node;
      first.to = second.from = edge.middle();
      halves.push_back(first);
      halves.push_back(second);
    }
    return halves;
  }

 private:
  std::size_t side(const EdgeUse& use) const {
    std::size_t i = 3 * at(use.triangle);
    while (_base.triangles[i] != use.from) ++i;
    return i;
  }

  void put(const BentEdge& edge, const Point& p) {
    const auto node = 2 * at(between(edge.a, edge.b));
    _xy[node] = p[0];
    _xy[node + 1] = p[1];
  }

  /// Puts the midpoint of an edge back onto it, and returns true, if it spoils a triangle.
  bool put_back(const BentEdge& edge) {
    const auto spoilt = [this](const EdgeUse& use) { return spoils(at(use.triangle)); };
    if (std::ranges::none_of(_edges.find(edge.a, edge.b), spoilt)) return false;
    const Point a = position(_base, edge.a), b = position(_base, edge.b);
    put(edge, {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])});
    return true;
  }

  /// Whether a part has less than half the area of a quarter.
  bool spoils(std::size_t triangle) const {
    const auto place = [this](std::int32_t node) {
      return Point{_xy[2 * at(node)], _xy[2 * at(node) + 1]};
    };
    return std::ranges::any_of(parts(triangle), [&](const std::array<std::int32_t, 3>& part) {
      return signed_area(std::array{place(part[0]), place(part[1]), place(part[2])}) <
             area(_base, triangle) / 8;
    });
  }

  const Mesh& _base;
  std::vector<double>& _xy;
  EdgeTable _edges;
  std::vector<std::int32_t> _of_side;
};

Interface cut(const Interface& whole, const EdgeMidpoints& midpoint) {
  Interface fine;
  fine.name = whole.name;
  fine.nodes.reserve(2 * whole.nodes.size());
  for (std::size_t i = 0; i + 1 < whole.nodes.size(); ++i) {
    fine.nodes.push_back(whole.nodes[i]);
    fine.nodes.push_back(midpoint.between(whole.nodes[i], whole.nodes[i + 1]));
    fine.kind.insert(fine.kind.end(), 2, whole.kind[i]);
    fine.inclusion.insert(fine.inclusion.end(), 2, whole.inclusion[i]);
  }
  fine.nodes.push_back(whole.nodes.back());
  return fine;
}

}  // namespace

Mesh refine_uniform(const Mesh& base) {
  // there are at most as many midpoints as sides
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (base.node_count() + base.triangles.size() > most || base.triangle_count() > most / 4) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "refining {} triangles would give more than can be numbered",
                        base.triangle_count());
  }
  Mesh fine = without_triangles(base);
  fine.xy.reserve(8 * base.node_count());
  fine.xy = base.xy;
  EdgeMidpoints midpoint(base, fine.xy);
  fine.bent = midpoint.bend();
  fine.triangles.reserve(4 * base.triangles.size());
  fine.subdomain.reserve(4 * base.subdomain.size());
  for (std::size_t t = 0; t < base.triangle_count(); ++t) {
    stop::look_at_turn<stop::quick>(t, halving, 4 * t);
    for (const std::array<std::int32_t, 3>& part : midpoint.parts(t))
      fine.triangles.insert(fine.triangles.end(), part.begin(), part.end());
    fine.subdomain.insert(fine.subdomain.end(), 4, base.subdomain[t]);
  }
  for (const Interface& interface : base.interfaces)
    fine.interfaces.push_back(cut(interface, midpoint));
  for (const ChordEdge& edge : base.chords) {
    const auto halves = edge.halved(midpoint.between(edge.a, edge.b));
    fine.chords.insert(fine.chords.end(), halves.begin(), halves.end());
  }
  fine.dirichlet.reserve(2 * base.dirichlet.size());
  for (const auto& [a, b] : base.dirichlet) {
    const std::int32_t middle = midpoint.between(a, b);
    fine.dirichlet.push_back({a, middle});
    fine.dirichlet.push_back({middle, b});
  }
  // a quarter is similar to the whole, so the bound of all bisections holds for it
  fine.bisection_bound = base.bisection_bound;
  return fine;
}

}  // namespace anticrack::mesh
