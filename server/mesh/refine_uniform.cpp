// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refine_uniform.hpp"

#include <array>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/edges.hpp"

namespace anticrack::mesh {
namespace {

/// The midpoints of all edges; their numbers follow those of the base's nodes.
class Midpoints {
 public:
  Midpoints(const Mesh& base, std::vector<double>& xy)
      : _base(base), _edges(base.triangles), _of_side(base.triangles.size()) {
    _edges.each([&](std::span<const EdgeUse> uses) {
      const auto node = static_cast<std::int32_t>(xy.size() / 2);
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

 private:
  std::size_t side(const EdgeUse& use) const {
    std::size_t i = 3 * at(use.triangle);
    while (_base.triangles[i] != use.from) ++i;
    return i;
  }

  const Mesh& _base;
  EdgeTable _edges;
  std::vector<std::int32_t> _of_side;
};

Interface cut(const Interface& whole, const Midpoints& midpoint) {
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
  const Midpoints midpoint(base, fine.xy);
  fine.triangles.reserve(4 * base.triangles.size());
  fine.subdomain.reserve(4 * base.subdomain.size());
  for (std::size_t t = 0; t < base.triangle_count(); ++t) {
    const std::int32_t* corner = &base.triangles[3 * t];
    const std::int32_t ab = midpoint(t, 0), bc = midpoint(t, 1), ca = midpoint(t, 2);
    for (const std::array<std::int32_t, 3>& part :
         {std::array{corner[0], ab, ca}, std::array{ab, corner[1], bc},
          std::array{ca, bc, corner[2]}, std::array{ab, bc, ca}})
      fine.triangles.insert(fine.triangles.end(), part.begin(), part.end());
    fine.subdomain.insert(fine.subdomain.end(), 4, base.subdomain[t]);
  }
  for (const Interface& interface : base.interfaces)
    fine.interfaces.push_back(cut(interface, midpoint));
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
