// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/size_rule.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

constexpr std::size_t centres_in_a_leaf = 8;

/// With many tips, bisection stops at this fraction of the radius R (h0/R)^{1/m}, below which the
/// rule requires less than the distance itself.
constexpr double tip_part = 1e-3;

void require(bool holds, const char* field, double value, const std::string& rule) {
  if (holds) return;
  throw errors::Error(errors::Reason::invalid_argument, "{} = {:g}; it must be {}", field, value,
                      rule)
      .at(field);
}

void check(const Grading& grading) {
  const auto& [h0, m, tip_size, least] = grading;
  require(std::isfinite(h0) && h0 > 0, "h0", h0, "an edge length above 0");
  require(m > 0 && m <= 1, "m", m, "positive and at most 1, say 0.2");
  require(std::isfinite(tip_size) && tip_size >= 0, "tip_size", tip_size,
          "an edge length, or 0 for the default");
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

/// Squared distance of a triangle from a point that is not inside it.
double squared_distance(const std::array<Point, 3>& triangle, const Point& from) noexcept {
  const Point a = minus(triangle[0], from);
  const Point b = minus(triangle[1], from);
  const Point c = minus(triangle[2], from);
  return std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
}

/// For each node the length of the longest crack or part of an inclusion that ends there, else 0.
std::vector<double> lengths_ending(const Mesh& mesh) {
  std::vector<double> longest(mesh.node_count(), 0.0);
  for (const Interface& line : mesh.interfaces) {
    for (std::size_t first = 0; first < line.kind.size();) {
      double length = 0;
      std::size_t end = first;
      for (; end < line.kind.size() && line.kind[end] == line.kind[first] &&
             line.inclusion[end] == line.inclusion[first];
           ++end)
        length += distance(position(mesh, line.nodes[end]), position(mesh, line.nodes[end + 1]));
      if (line.kind[first] != Kind::glue) {
        for (const std::int32_t node : {line.nodes[first], line.nodes[end]})
          longest[at(node)] = std::max(longest[at(node)], length);
      }
      first = end;
    }
  }
  return longest;
}

}  // namespace

SizeRule::SizeRule(const Mesh& mesh, std::span<const std::int32_t> centres, const Grading& grading)
    : _h0(grading.h0), _tip_size(grading.h0) {
  check(grading);
  const double floor = std::max(grading.least_tip_size, smallest_tip_size(mesh, centres));
  const std::string least = fmt::format(
      "at least {:g}, the smallest size whose triangles keep their shape in double precision next "
      "to the tips of this mesh",
      floor);
  require(_h0 >= floor, "h0", _h0, least);
  require(!(grading.tip_size > 0 && grading.tip_size < floor), "tip_size", grading.tip_size, least);
  // with m = 1 the size does not depend on the distance, and the exponent would be infinite
  if (grading.m == 1 || centres.empty()) return;
  _exponent = 1 / (1 - grading.m);

  const double whole = characteristic_length(mesh);
  const double share = tip_share(whole, centres.size());
  const std::vector<double> lengths = lengths_ending(mesh);
  for (const std::int32_t node : centres) {
    const double reach = std::clamp(lengths[at(node)], share, whole);
    double tip_size = grading.tip_size;
    if (tip_size == 0) {
      const double end = reach * std::pow(_h0 / reach, 1 / grading.m);
      tip_size = share < whole ? std::clamp(tip_part * end, floor, _h0) : floor;
    }
    _tip_size = std::min(_tip_size, tip_size);
    _centres.push_back({position(mesh, node), reach, tip_size});
  }
  _boxes = boxes_of(
      _centres, centres_in_a_leaf,
      [](const Centre& c) {
        return std::array{c.at, c.at};
      },
      [](const Centre& c) { return c.reach; }, [](double a, double b) { return std::max(a, b); });
}

bool SizeRule::Sought::beyond(const Point& box_low, const Point& box_high,
                              double reach) const noexcept {
  Point gap{};
  for (std::size_t axis = 0; axis < 2; ++axis)
    gap[axis] = std::max(std::max(box_low[axis] - high[axis], 0.0), low[axis] - box_high[axis]);
  return squared(gap) > reach * reach;
}

bool SizeRule::search(std::size_t index, const Sought& of) const noexcept {
  const Box& box = _boxes[index];
  if (of.beyond(box.low, box.high, box.value * of.part)) return false;
  if (box.left > 0) return search(box.left, of) || search(box.right, of);
  for (std::size_t i = box.begin; i < box.end; ++i) {
    const Centre& centre = _centres[i];
    const double reach = centre.reach * of.part;
    if (of.diameter > centre.tip_size && !of.beyond(centre.at, centre.at, reach) &&
        squared_distance(of.triangle, centre.at) < reach * reach)
      return true;
  }
  return false;
}

bool SizeRule::too_large(const std::array<Point, 3>& triangle) const noexcept {
  const auto& [a, b, c] = triangle;
  const double diameter =
      std::sqrt(std::max({squared(minus(b, a)), squared(minus(c, b)), squared(minus(a, c))}));
  if (diameter > _h0) return true;
  if (diameter <= _tip_size) return false;
  // the rule solved for r/R: the diameter is too large closer to a centre than this
  Sought of{triangle, a, a, diameter, std::pow(diameter / _h0, _exponent)};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    of.low[axis] = std::min(std::min(a[axis], b[axis]), c[axis]);
    of.high[axis] = std::max(std::max(a[axis], b[axis]), c[axis]);
  }
  return search(0, of);
}

}  // namespace anticrack::mesh
