// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/bisection.hpp"
#include "mesh/size_rule.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesh {
namespace {

/// Elements smaller than this fraction of a coordinate lose their shape by rounding of midpoints.
constexpr double relative_floor = 1e-13;

/// Up to this many tips, each has the reach that it would have alone.
constexpr double few_tips = 16;

[[noreturn]] void refuse_count(const Mesh& base, const Grading& grading, std::size_t limit) {
  throw errors::Error(
      errors::Reason::limit_exceeded,
      "grading {} triangles to h0 = {:g}, m = {:g} takes more than the {} triangles allowed; raise "
      "h0 (twice the size takes a quarter of the triangles), m or tip_size, or the limit",
      base.triangle_count(), grading.h0, grading.m, limit)
      .at("h0");
}

}  // namespace

double characteristic_length(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) sum += area(mesh, t);
  return 0.5 * std::sqrt(sum);
}

double tip_share(double length, std::size_t tip_count) noexcept {
  return length * std::min(1.0, std::sqrt(few_tips / static_cast<double>(tip_count)));
}

double smallest_tip_size(const Mesh& mesh, std::span<const std::int32_t> centres) {
  double largest = characteristic_length(mesh);
  for (const std::int32_t node : centres) {
    const auto [x, y] = position(mesh, node);
    largest = std::max({largest, std::abs(x), std::abs(y)});
  }
  return relative_floor * largest;
}

std::vector<std::int32_t> tips(const Mesh& mesh) {
  const EdgeTable edges(mesh.triangles);
  return tips(mesh, edges, edge_ends(mesh, edges));
}

std::vector<std::int32_t> tips(const Mesh& mesh, const EdgeTable& edges,
                               std::span<const EdgeEnd> ends) {
  const std::vector<bool> on_boundary = edges.boundary_nodes(mesh.node_count());
  const auto free_end = [&](const EdgeEnd& end) {
    if (end.kind == Kind::glue) return false;
    return !on_boundary[at(end.node)] || edges.find(end.node, end.other).size() == 1;
  };

  std::vector<std::int32_t> found;
  for (auto first = ends.begin(); first != ends.end();) {
    const auto last = std::find_if(
        first, ends.end(), [node = first->node](const EdgeEnd& end) { return end.node != node; });
    const bool differ = std::any_of(first, last, [&](const EdgeEnd& end) {
      return end.kind != first->kind || end.inclusion != first->inclusion;
    });
    if (differ || (last - first == 1 && free_end(*first))) found.push_back(first->node);
    first = last;
  }
  return found;
}

Mesh grade(const Mesh& base, const Grading& grading, std::size_t max_triangles) {
  return grade(base, tips(base), grading, max_triangles);
}

Mesh grade(const Mesh& base, std::span<const std::int32_t> centres, const Grading& grading,
           std::size_t max_triangles) {
  const SizeRule rule(base, centres, grading);
  if (base.triangle_count() > max_triangles) refuse_count(base, grading, max_triangles);
  Bisection mesh(base, std::min(max_triangles, at(std::numeric_limits<std::int32_t>::max())));
  // One pass suffices: children of a small enough triangle are small enough, new ones come last.
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    stop::look_at_turn(t, bisecting, mesh.triangle_count());
    while (rule.too_large(mesh.corners(t)))
      if (!mesh.bisect(t)) refuse_count(base, grading, max_triangles);
  }
  return std::move(mesh).finish();
}

Mesh refine(const Mesh& base, std::span<const std::uint8_t> levels, std::size_t max_triangles) {
  Bisection mesh(base, std::min(max_triangles, at(std::numeric_limits<std::int32_t>::max())));
  const auto twice_area = [](const std::array<Point, 3>& p) {
    return (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
  };
  // Twice the area of the smallest triangle there that keeps its shape.
  const auto least = [](const std::array<Point, 3>& p) {
    double largest = 0;
    for (const auto& [x, y] : p) largest = std::max({largest, std::abs(x), std::abs(y)});
    return std::pow(relative_floor * largest, 2);
  };
  // Areas are halved up to rounding, so half a level separates enough from not enough.
  std::vector<double> enough(base.triangle_count());
  for (std::size_t t = 0; t < enough.size(); ++t) {
    stop::look_at_turn(t, bisecting);
    enough[t] = twice_area(mesh.corners(t)) * std::exp2(0.5 - levels[t]);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    stop::look_at_turn(t, bisecting);
    for (auto p = mesh.corners(t); twice_area(p) > std::max(enough[at(mesh.origin(t))], least(p));
         p = mesh.corners(t)) {
      if (mesh.bisect(t)) continue;
      throw errors::Error(errors::Reason::limit_exceeded,
                          "refining {} triangles takes more than the {} allowed",
                          base.triangle_count(), max_triangles);
    }
  }
  return std::move(mesh).finish();
}

}  // namespace anticrack::mesh
