// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/release.hpp"

#include <algorithm>
#include <cmath>

namespace anticrack::tips {
namespace {

/// Where theta begins to fall, over its radius.
constexpr double theta_falls_from = 0.25;

}  // namespace

Corners corners_of(const std::array<Point, 3>& x) {
  Corners at{x, {}, 0};
  const Point b = minus(x[1], x[0]), c = minus(x[2], x[0]);
  const double twice = b[0] * c[1] - b[1] * c[0];
  at.area = 0.5 * twice;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point side = minus(x[(i + 2) % 3], x[(i + 1) % 3]);
    at.hat[i] = {-side[1] / twice, side[0] / twice};
  }
  return at;
}

Tensor change_of(const Law& law, const Course& course, const Corners& at, double radius) {
  Point centre{};
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 2; ++k) centre[k] += at.x[i][k] / 3;
    const Point side = minus(at.x[i], at.x[(i + 1) % 3]);
    size = std::max(size, std::hypot(side[0], side[1]));
  }
  const double step = std::max(0.25 * size, 1e-6 * radius);
  const Point& t = course.ahead;
  const auto moved = [&](double by) {
    return law.at({centre[0] + by * t[0], centre[1] + by * t[1]});
  };
  Tensor change = moved(step);
  const Tensor before = moved(-step);
  for (std::size_t i = 0; i < 3; ++i) change[i] = (change[i] - before[i]) / (2 * step);
  return change;
}

void Moved::add(const Corners& at, const std::array<double, 3>& u, const Tensor& tension,
                const double* force, const Point& slope, const Tensor* change,
                std::array<double, radii>& sum) const {
  Point g{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k) g[k] += (u[i] - u[0]) * at.hat[i][k];
  const Point flux = product(tension, g), rest = minus(g, slope);
  const double density = dot(flux, g) / 2;
  const double along = dot(_course.ahead, rest);
  std::array<double, 3> distance{}, worth{};
  const Point& t = _course.ahead;
  for (std::size_t i = 0; i < 3; ++i) {
    distance[i] = std::hypot(at.x[i][0] - _course.tip[0], at.x[i][1] - _course.tip[1]);
    worth[i] =
        at.area * (dot(flux, at.hat[i]) * along - density * dot(t, at.hat[i])) - force[i] * along;
  }
  const double changed = change == nullptr ? 0 : at.area * dot(product(*change, g), g) / 6;
  for (std::size_t r = 0; r < radii; ++r) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double theta =
          std::clamp((1 - distance[i] / _radii[r]) / (1 - theta_falls_from), 0.0, 1.0);
      sum[r] += theta * (worth[i] - changed);
    }
  }
}

}  // namespace anticrack::tips
