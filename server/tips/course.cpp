// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/course.hpp"

#include <cmath>

namespace anticrack::tips {
namespace {

Point combine(double a, const Point& p, double b, const Point& q) {
  return {a * p[0] + b * q[0], a * p[1] + b * q[1]};
}

}  // namespace

Point Course::tangent(const Point& x) const { return radius == 0 ? ahead : tangent_at(at(x).s); }

Along Course::at(const Point& x) const {
  const Point from = minus(x, tip);
  const double a = dot(from, ahead), b = dot(from, normal);
  if (radius == 0) return {a, b, ahead, normal, 1};
  // From the centre, towards the tip: of the angle turned, sine and cosine times the distance.
  const double sign = radius > 0 ? 1 : -1, size = std::abs(radius), to_tip = size - sign * b,
               distance = std::hypot(a, to_tip), angle = std::atan2(a, to_tip);
  Along result{size * angle, sign * (size - distance), {}, {}, size / distance};
  const double c = to_tip / distance, s = a / distance;
  result.grad_s = combine(c * result.area, ahead, sign * s * result.area, normal);
  result.grad_d = combine(-sign * s, ahead, c, normal);
  return result;
}

Point Course::place(double s) const {
  if (radius == 0) return combine(s, ahead, 0, normal);
  const double angle = s / radius;
  return combine(radius * std::sin(angle), ahead, 2 * radius * std::pow(std::sin(angle / 2), 2),
                 normal);
}

Point Course::tangent_at(double s) const {
  if (radius == 0) return ahead;
  const double angle = s / radius;
  return combine(std::cos(angle), ahead, std::sin(angle), normal);
}

}  // namespace anticrack::tips
