// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <tuple>
#include <utility>

#include "errors/errors.hpp"
#include "mesh/at.hpp"
#include "mesh/bisection.hpp"
#include "mesh/edges.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

/// Elements smaller than this part of a coordinate lose their shape to the rounding of midpoints.
constexpr double relative_floor = 1e-13;

template <class... Parts>
[[noreturn]] void refuse_value(const char* field, const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw errors::Error(errors::Reason::invalid_argument, text.str()).at(field);
}

double squared(const Point& p) noexcept { return p[0] * p[0] + p[1] * p[1]; }

/// Squared distance of the origin from the segment from p to q.
double squared_distance(const Point& p, const Point& q) noexcept {
  const Point e = minus(q, p);
  const double along = -(p[0] * e[0] + p[1] * e[1]);
  const double length = squared(e);
  if (along <= 0 || !(length > 0)) return squared(p);
  if (along >= length) return squared(q);
  const double t = along / length;
  return squared({p[0] + t * e[0], p[1] + t * e[1]});
}

/// Of a triangle from a point that is not inside it.
double squared_distance(const std::array<Point, 3>& triangle, const Point& from) noexcept {
  const Point a = minus(triangle[0], from);
  const Point b = minus(triangle[1], from);
  const Point c = minus(triangle[2], from);
  return std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
}

void check(const Grading& grading) {
  if (!(std::isfinite(grading.h0) && grading.h0 > 0))
    refuse_value("h0", "h0 = ", grading.h0, "; it is an edge length and must be positive");
  if (!(grading.m > 0 && grading.m <= 1))
    refuse_value("m", "m = ", grading.m, "; it must be positive and at most 1, say 0.2");
  if (!(std::isfinite(grading.tip_size) && grading.tip_size >= 0)) {
    refuse_value("tip_size", "tip_size = ", grading.tip_size,
                 "; it must be an edge length, or 0 for the smallest sound one");
  }
}

/// The rule of `Grading`, its numbers checked and `tip_size` settled.
class SizeRule {
 public:
  /// Throws errors::Error (invalid_argument) at "h0", "m" or "tip_size". O(m + c log c).
  SizeRule(const Mesh& mesh, std::span<const std::int32_t> centres, const Grading& grading);

  /// Whether the longest edge exceeds what the distance to the nearest centre allows; distances
  /// from exact differences to the centre. O(log c + centres in reach).
  bool too_large(const std::array<Point, 3>& triangle) const noexcept;

 private:
  double _h0;
  double _tip_size;
  double _radius;     ///< R
  double _exponent;   ///< 1/(1-m)
  std::size_t _axis;  ///< the coordinate by which the centres are sorted: where they spread wider
  std::vector<Point> _centres;
};

SizeRule::SizeRule(const Mesh& mesh, std::span<const std::int32_t> centres, const Grading& grading)
    : _h0(grading.h0), _tip_size(grading.tip_size), _radius(0), _exponent(1), _axis(0) {
  check(grading);
  _radius = characteristic_length(mesh);
  const double floor = smallest_tip_size(mesh, centres);
  if (_h0 < floor) {
    refuse_value("h0", "h0 = ", _h0, "; in this mesh ", floor, " is the smallest size whose ",
                 "triangles keep their shape in double precision");
  }
  if (_tip_size == 0) {
    _tip_size = floor;
  } else if (_tip_size < floor) {
    refuse_value("tip_size", "tip_size = ", _tip_size, "; next to these tips ", floor,
                 " is the smallest size whose triangles keep their shape in double precision");
  }
  // with m = 1 the size does not depend on the distance, and the exponent would be infinite
  if (grading.m == 1) _tip_size = _h0;
  _exponent = grading.m == 1 ? 1 : 1 / (1 - grading.m);

  for (const std::int32_t node : centres) _centres.push_back(position(mesh, node));
  std::array<double, 2> spread{};
  for (std::size_t axis = 0; axis < 2 && !_centres.empty(); ++axis) {
    const auto [low, high] =
        std::ranges::minmax(_centres, {}, [axis](const Point& p) { return p[axis]; });
    spread[axis] = high[axis] - low[axis];
  }
  _axis = spread[1] > spread[0] ? 1 : 0;
  std::ranges::sort(_centres, {}, [this](const Point& p) { return p[_axis]; });
}

bool SizeRule::too_large(const std::array<Point, 3>& triangle) const noexcept {
  const auto& [a, b, c] = triangle;
  const double diameter =
      std::sqrt(std::max({squared(minus(b, a)), squared(minus(c, b)), squared(minus(a, c))}));
  if (diameter > _h0) return true;
  if (diameter <= _tip_size) return false;
  // the rule solved for r: closer to a centre than this, the diameter is too large
  const double reach = _radius * std::pow(diameter / _h0, _exponent);
  const auto [low, high] = std::minmax({a[_axis], b[_axis], c[_axis]});
  const auto by_axis = [this](const Point& p) { return p[_axis]; };
  for (auto centre = std::ranges::lower_bound(_centres, low - reach, {}, by_axis);
       centre != _centres.end() && (*centre)[_axis] <= high + reach; ++centre)
    if (squared_distance(triangle, *centre) < reach * reach) return true;
  return false;
}

[[noreturn]] void refuse_count(const Mesh& base, const Grading& grading, std::size_t limit) {
  std::ostringstream text;
  text << "grading " << base.triangle_count() << " triangles to h0 = " << grading.h0
       << ", m = " << grading.m << " takes more than the " << limit
       << " triangles allowed; raise h0 (twice the size takes a quarter of the triangles), m or "
          "tip_size, or the limit";
  throw errors::Error(errors::Reason::limit_exceeded, text.str()).at("h0");
}

/// An interface edge as one of its ends sees it.
struct EdgeEnd {
  std::int32_t node = 0;
  std::int32_t other = 0;
  Kind kind = Kind::glue;
  std::int32_t inclusion = -1;
};

std::vector<EdgeEnd> interface_edge_ends(const Mesh& mesh) {
  std::vector<EdgeEnd> ends;
  for (const Interface& line : mesh.interfaces) {
    for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
      const std::int32_t a = line.nodes[i];
      const std::int32_t b = line.nodes[i + 1];
      ends.push_back({a, b, line.kind[i], line.inclusion[i]});
      ends.push_back({b, a, line.kind[i], line.inclusion[i]});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& p, const EdgeEnd& q) {
    return std::tuple(p.node, p.other) < std::tuple(q.node, q.other);
  });
  return ends;
}

}  // namespace

double characteristic_length(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) sum += area(mesh, t);
  return 0.5 * std::sqrt(sum);
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
  const std::vector<EdgeEnd> ends = interface_edge_ends(mesh);
  const EdgeTable edges(mesh.triangles);
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
    while (rule.too_large(mesh.corners(t)))
      if (!mesh.bisect(t)) refuse_count(base, grading, max_triangles);
  }
  return std::move(mesh).finish();
}

}  // namespace anticrack::mesh
