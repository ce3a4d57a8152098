// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/extraction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/triangle_rules.hpp"

namespace anticrack::tips {
namespace {

/// The largest |x| at r = 1, x in (s, d), is this root: r^2 = D x.T0^-1 x.
double longest(const Tensor& t) {
  const double mean = 0.5 * (t[0] + t[2]), half = std::hypot(0.5 * (t[0] - t[2]), t[1]);
  return std::sqrt((mean + half) / root_of_determinant(t));
}

}  // namespace

Flattened::Flattened(const Tensor& at_tip)
    : slant(at_tip[1] / at_tip[2]),
      stretch(root_of_determinant(at_tip) / at_tip[2]),
      root(root_of_determinant(at_tip)),
      tip(at_tip) {}

Extraction::Extraction(const Course& course, const Singular& singular,
                       const std::array<Tensor, 2>& sides, double radius)
    : _course(course),
      _singular(singular),
      _sides{Flattened(sides[0]), Flattened(sides[1])},
      _outer(radius / std::max(longest(sides[0]), longest(sides[1]))) {
  // An arc bends away from its tangent: what is at distance s, d along it is nearer to the tip.
  if (course.radius != 0) _outer *= 0.8;
}

Extraction::Cutoff Extraction::cutoff(double r) const {
  const double x = std::min(1.0, r / _outer);
  return {1 - x * x * x * (10 + x * (6 * x - 15)), -30 * x * x * (1 - x) * (1 - x) / _outer,
          -60 * x * (1 - x) * (1 - 2 * x) / (_outer * _outer)};
}

void Extraction::add(const Corners& at, const Tensor& tension, std::size_t side,
                     const std::array<bool, 3>& jumps) {
  const Flattened& flat = _sides[side];
  const double alpha = _singular.exponent();
  Weights weights;
  Point on_gradient{};  // what multiplies grad u
  std::array<double, 3> moments{};  // int w hat_i
  constexpr const auto& rule = fem::rule_5;
  for (std::size_t q = 0; q < rule.size; ++q) {
    const std::array<double, 3> hat{1 - rule.b[q] - rule.c[q], rule.b[q], rule.c[q]};
    Point x{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 2; ++k) x[k] += hat[i] * at.x[i][k];
    const Along along = _course.at(x);
    const double flat_x = along.s - flat.slant * along.d, r = std::hypot(flat_x, flat.stretch * along.d);
    if (r >= _outer || r == 0) continue;
    // Between a chord and its arc a point is beyond the faces; behind the tip its triangle counts.
    double flat_y = flat.stretch * along.d;
    if (flat_x < 0 && (flat_y > 0) != (side == 1)) flat_y = side == 1 ? 0.0 : -0.0;
    const double theta = std::atan2(flat_y, flat_x), weight = rule.weight[q] * at.area;
    const auto [chi, chi_1, chi_2] = cutoff(r);
    const auto [phi, phi_1] = _singular.phi(theta, side);
    const double power = std::pow(r, -alpha), w = chi * power * phi;
    // dX dY = stretch ds dd
    const double on_u = weight * along.area * flat.stretch * flat.root * power * phi *
                        (chi_2 + (1 - 2 * alpha) * chi_1 / r);
    const Point place = _course.place(flat_x);
    for (std::size_t i = 0; i < 3; ++i) {
      weights.u[i] += on_u * hat[i];
      moments[i] += weight * w * hat[i];
    }
    for (std::size_t k = 0; k < 2; ++k) _of_slope[k] += on_u * place[k];

    // grad'w in (s, d): by r and theta, X and Y.
    const double by_r = power * phi * (chi_1 - alpha * chi / r), by_angle = chi * power * phi_1 / r,
                 c = std::cos(theta), s = std::sin(theta), w_x = c * by_r - s * by_angle,
                 w_y = s * by_r + c * by_angle;
    if (_course.radius != 0) {  // u0' less its value at the tip, which has no part
      const Point t = minus(_course.tangent_at(flat_x), _course.ahead);
      for (std::size_t k = 0; k < 2; ++k)
        _of_slope[k] += weight * along.area * flat.stretch * flat.root * w_x * t[k];
    }
    const Point slope{w_x, flat.stretch * w_y - flat.slant * w_x};
    // int (T' - T0) grad'u.grad'w ds dd = int grad u.(T J' - det J J^-1 T0) grad'w dx
    const Point of_law = product(
        tension, Point{along.grad_s[0] * slope[0] + along.grad_d[0] * slope[1],
                       along.grad_s[1] * slope[0] + along.grad_d[1] * slope[1]});
    const Point of_tip = product(flat.tip, slope);
    // J has the rows grad_s, grad_d, which are orthogonal: J^-1 has the columns grad / |grad|^2.
    const double stretched = along.area * along.area;  // |grad_s|^2; |grad_d| = 1
    for (std::size_t k = 0; k < 2; ++k)
      on_gradient[k] += weight * (of_law[k] - along.area * (along.grad_s[k] / stretched * of_tip[0] +
                                                            along.grad_d[k] * of_tip[1]));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    weights.u[i] -= dot(on_gradient, at.hat[i]);
    // int f w by int f hat_i: the linear function with the moments of w.
    weights.force[i] =
        3 / at.area * (4 * moments[i] - (moments[0] + moments[1] + moments[2]));
    if (!jumps[i] || side != 0) continue;
    const double r = std::abs(_course.at(at.x[i]).s);
    if (r >= _outer || r == 0) continue;
    const double jump = cutoff(r).value * std::pow(r, -alpha) * _singular.jump();
    weights.force[i] += jump;
    for (std::size_t k = 0; k < 3; ++k)
      weights.u[k] -= jump * at.area * dot(product(tension, at.hat[i]), at.hat[k]);
  }
  _weights.push_back(weights);
}

double Extraction::part(std::size_t cell, const std::array<double, 3>& u,
                        const double* force) const {
  const Weights& weights = _weights[cell];
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += weights.u[i] * u[i] + weights.force[i] * force[i];
  return sum;
}

}  // namespace anticrack::tips
