// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/size_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesher {
namespace {

constexpr std::size_t curves_in_a_leaf = 4;

}  // namespace

SizeField::SizeField(std::vector<SizedCurve> curves, double growth)
    : _curves(std::move(curves)), _growth(growth) {
  for (const SizedCurve& curve : _curves) _longest = std::max(_longest, curve.size);
  _boxes = mesh::boxes_of(
      _curves, curves_in_a_leaf,
      [](const SizedCurve& c) {
        return std::array{c.a, c.b};
      },
      [](const SizedCurve& c) { return c.size; },
      [](double a, double b) { return std::min(a, b); });
}

double SizeField::bound(const mesh::Box& box, const mesh::Point& p) const {
  const double dx = std::max({box.low[0] - p[0], 0.0, p[0] - box.high[0]});
  const double dy = std::max({box.low[1] - p[1], 0.0, p[1] - box.high[1]});
  return box.value + _growth * std::hypot(dx, dy);
}

void SizeField::search(std::size_t index, const mesh::Point& p, double& best) const {
  const mesh::Box& box = _boxes[index];
  if (box.left == 0) {
    for (std::size_t i = box.begin; i < box.end; ++i) {
      const SizedCurve& c = _curves[i];
      best = std::min(best, c.size + _growth * mesh::distance(p, mesh::Segment{c.a, c.b}));
    }
    return;
  }
  double near = bound(_boxes[box.left], p);
  double far = bound(_boxes[box.right], p);
  std::size_t first = box.left;
  std::size_t second = box.right;
  if (far < near) {
    std::swap(near, far);
    std::swap(first, second);
  }
  if (near < best) search(first, p, best);
  if (far < best) search(second, p, best);
}

double SizeField::operator()(const mesh::Point& p) const {
  double best = _longest;
  search(0, p, best);
  return best;
}

}  // namespace anticrack::mesher
