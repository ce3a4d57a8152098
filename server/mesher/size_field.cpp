// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/size_field.hpp"

#include <algorithm>
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
  _boxes.reserve(2 * _curves.size());
  build(0, _curves.size());
}

std::size_t SizeField::build(std::size_t begin, std::size_t end) {
  const std::size_t index = _boxes.size();
  Box box{_curves[begin].a, _curves[begin].a, _curves[begin].size, begin, end, 0, 0};
  for (std::size_t i = begin; i < end; ++i) {
    for (const mesh::Point& p : {_curves[i].a, _curves[i].b}) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        box.low[axis] = std::min(box.low[axis], p[axis]);
        box.high[axis] = std::max(box.high[axis], p[axis]);
      }
    }
    box.least = std::min(box.least, _curves[i].size);
  }
  _boxes.push_back(box);
  if (end - begin <= curves_in_a_leaf) return index;
  const std::size_t axis = box.high[0] - box.low[0] > box.high[1] - box.low[1] ? 0 : 1;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return _curves.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const SizedCurve& c, const SizedCurve& d) {
                     return c.a[axis] + c.b[axis] < d.a[axis] + d.b[axis];
                   });
  const std::size_t left = build(begin, middle);
  const std::size_t right = build(middle, end);
  _boxes[index].left = left;
  _boxes[index].right = right;
  return index;
}

double SizeField::bound(const Box& box, const mesh::Point& p) const {
  const double dx = std::max({box.low[0] - p[0], 0.0, p[0] - box.high[0]});
  const double dy = std::max({box.low[1] - p[1], 0.0, p[1] - box.high[1]});
  return box.least + _growth * std::hypot(dx, dy);
}

void SizeField::search(std::size_t index, const mesh::Point& p, double& best) const {
  const Box& box = _boxes[index];
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
