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
      _outer(radius / std::max(longest(sides[0]), longest(sides[1]))),
      _inverse(1 / _outer) {}

Extraction::Cutoff Extraction::cutoff(double r) const {
  const double x = std::min(1.0, r * _inverse);
  return {1 - x * x * x * (10 + x * (6 * x - 15)), -30 * x * x * (1 - x) * (1 - x) * _inverse,
          -60 * x * (1 - x) * (1 - 2 * x) * _inverse * _inverse};
}

void Extraction::add(const Corners& at, const Tensor& tension, std::size_t side,
                     const std::array<bool, 3>& jumps) {
  const Flattened& flat = _sides[side];
  const double alpha = _singular.exponent();
  Weights weights;
  Point on_gradient{};              // what multiplies grad u
  std::array<double, 3> moments{};  // int w hat_i
  constexpr const auto& rule = fem::rule_5;
  for (std::size_t q = 0; q < rule.size; ++q) {
    const std::array<double, 3> hat{1 - rule.b[q] - rule.c[q], rule.b[q], rule.c[q]};
    Point x{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 2; ++k) x[k] += hat[i] * at.x[i][k];
    const double across = _course.across(x), flat_x = _course.along(x) - flat.slant * across,
                 flat_y = flat.stretch * across, r = std::sqrt(flat_x * flat_x + flat_y * flat_y);
    if (r >= _outer || r == 0) continue;
    const double per_r = 1 / r, c = flat_x * per_r, s = flat_y * per_r,
                 weight = rule.weight[q] * at.area;
    const auto [chi, chi_1, chi_2] = cutoff(r);
    const auto [phi, phi_1] = _singular.phi({c, s}, side);
    const double power = _singular.power(r), w = chi * power * phi;
    // dX dY = stretch ds dd
    const double on_u =
        weight * flat.stretch * flat.root * power * phi * (chi_2 + (1 - 2 * alpha) * chi_1 * per_r);
    for (std::size_t i = 0; i < 3; ++i) {
      weights.u[i] += on_u * hat[i];
      moments[i] += weight * w * hat[i];
    }
    _of_slope += on_u * flat_x;

    // grad w in (s, d) and in (x, y), by r and theta, X and Y.
    const double by_r = power * phi * (chi_1 - alpha * chi * per_r),
                 by_angle = chi * power * phi_1 * per_r, w_x = c * by_r - s * by_angle,
                 w_y = s * by_r + c * by_angle;
    const Point slope{w_x, flat.stretch * w_y - flat.slant * w_x},
        of_tip = product(flat.tip, slope);
    Point in_plane{};
    for (std::size_t k = 0; k < 2; ++k)
      in_plane[k] = _course.ahead[k] * slope[0] + _course.normal[k] * slope[1];
    const Point of_law = product(tension, in_plane);
    for (std::size_t k = 0; k < 2; ++k)
      on_gradient[k] +=
          weight * (of_law[k] - _course.ahead[k] * of_tip[0] - _course.normal[k] * of_tip[1]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    weights.u[i] -= dot(on_gradient, at.hat[i]);
    // int f w by int f hat_i: the linear function with the moments of w.
    weights.force[i] = 3 / at.area * (4 * moments[i] - (moments[0] + moments[1] + moments[2]));
    if (!jumps[i] || side != 0) continue;
    const double r = std::abs(_course.along(at.x[i]));
    if (r >= _outer || r == 0) continue;
    const double jump = cutoff(r).value * _singular.power(r) * _singular.jump();
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
