// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/extraction.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "fem/triangle_rules.hpp"

namespace anticrack::tips {
namespace {

/// The largest |x| at r = 1, x in (s, d), is this root: r^2 = D x.T0^-1 x.
double longest(const Tensor& t) {
  const double mean = 0.5 * (t[0] + t[2]), half = std::hypot(0.5 * (t[0] - t[2]), t[1]);
  return std::sqrt((mean + half) / root_of_determinant(t));
}

/// The points of a rule of degree 5 in barycentric coordinates, and one more without a weight.
struct Points {
  std::array<Lanes, 3> hat{};
  Lanes weight{};
};
constexpr Points points = [] {
  Points result;
  for (std::size_t q = 0; q < std::tuple_size_v<Lanes>; ++q) {
    const bool more = q == fem::rule_5.size;
    const double b = fem::rule_5.b[more ? 0 : q], c = fem::rule_5.c[more ? 0 : q];
    result.hat[0][q] = 1 - b - c;
    result.hat[1][q] = b;
    result.hat[2][q] = c;
    result.weight[q] = more ? 0 : fem::rule_5.weight[q];
  }
  return result;
}();

double sum(const Lanes& lanes) { return std::accumulate(lanes.begin(), lanes.end() - 1, 0.0); }
double sum_of_products(const Lanes& a, const Lanes& b) {
  return std::inner_product(a.begin(), a.end() - 1, b.begin(), 0.0);
}

}  // namespace

Flattened::Flattened(const Tensor& at_tip)
    : slant(at_tip[1] / at_tip[2]),
      stretch(root_of_determinant(at_tip) / at_tip[2]),
      root(root_of_determinant(at_tip)),
      tip(at_tip) {}

Extraction::Extraction(const Course& course, const Singular& singular,
                       const std::array<Tensor, 2>& sides, double radius, std::size_t triangles)
    : _course(course),
      _singular(singular),
      _sides{Flattened(sides[0]), Flattened(sides[1])},
      _outer(radius / std::max(longest(sides[0]), longest(sides[1]))),
      _inverse(1 / _outer) {
  _weights.reserve(triangles);
}

Extraction::Cutoff Extraction::cutoff(double r) const {
  const double x = std::min(1.0, r * _inverse);
  return {1 - x * x * x * (10 + x * (6 * x - 15)), -30 * x * x * (1 - x) * (1 - x) * _inverse,
          -60 * x * (1 - x) * (1 - 2 * x) * _inverse * _inverse};
}

void Extraction::add(const Corners& at, const Tensor& tension, std::size_t side,
                     const std::array<bool, 3>& jumps) {
  const Flattened& flat = _sides[side];
  const double alpha = _singular.exponent(), outer = _outer, area = at.area;
  Lanes flat_x, flat_y, weight, r, cosine, sine;
  for (std::size_t q = 0; q < r.size(); ++q) {
    Point x{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 2; ++k) x[k] += points.hat[i][q] * at.x[i][k];
    const double across = _course.across(x);
    flat_x[q] = _course.along(x) - flat.slant * across;
    flat_y[q] = flat.stretch * across;
    r[q] = std::sqrt(flat_x[q] * flat_x[q] + flat_y[q] * flat_y[q]);
  }
  for (std::size_t q = 0; q < r.size(); ++q) {
    weight[q] = points.weight[q] * area * (r[q] < outer ? 1.0 : 0.0) * (r[q] > 0 ? 1.0 : 0.0);
    r[q] = r[q] > 0 ? r[q] : outer;
    cosine[q] = flat_x[q] * (1 / r[q]);
    sine[q] = flat_y[q] * (1 / r[q]);
  }
  const auto [phi, phi_1] = _singular.phi(cosine, sine, side);
  const Lanes power = _singular.power(r);
  Lanes on_u, on_force, on_x, on_y;  // what multiplies u, f and grad u
  for (std::size_t q = 0; q < r.size(); ++q) {
    const auto [chi, chi_1, chi_2] = cutoff(r[q]);
    const double per_r = 1 / r[q], w = chi * power[q] * phi[q];
    // dX dY = stretch ds dd
    on_u[q] = weight[q] * flat.stretch * flat.root * power[q] * phi[q] *
              (chi_2 + (1 - 2 * alpha) * chi_1 * per_r);
    on_force[q] = weight[q] * w;

    // grad w in (s, d) and in (x, y), by r and theta, X and Y.
    const double by_r = power[q] * phi[q] * (chi_1 - alpha * chi * per_r),
                 by_angle = chi * power[q] * phi_1[q] * per_r,
                 w_x = cosine[q] * by_r - sine[q] * by_angle,
                 w_y = sine[q] * by_r + cosine[q] * by_angle;
    const Point slope{w_x, flat.stretch * w_y - flat.slant * w_x},
        of_tip = product(flat.tip, slope);
    Point in_plane{};
    for (std::size_t k = 0; k < 2; ++k)
      in_plane[k] = _course.ahead[k] * slope[0] + _course.normal[k] * slope[1];
    const Point of_law = product(tension, in_plane);
    on_x[q] =
        weight[q] * (of_law[0] - _course.ahead[0] * of_tip[0] - _course.normal[0] * of_tip[1]);
    on_y[q] =
        weight[q] * (of_law[1] - _course.ahead[1] * of_tip[0] - _course.normal[1] * of_tip[1]);
  }
  Weights weights;
  const Point on_gradient{sum(on_x), sum(on_y)};
  std::array<double, 3> moments{};  // int w hat_i
  for (std::size_t i = 0; i < 3; ++i) {
    weights.u[i] = sum_of_products(on_u, points.hat[i]);
    moments[i] = sum_of_products(on_force, points.hat[i]);
  }
  _of_slope += sum_of_products(on_u, flat_x);
  for (std::size_t i = 0; i < 3; ++i) {
    weights.u[i] -= dot(on_gradient, at.hat[i]);
    // int f w by int f hat_i: the linear function with the moments of w.
    weights.force[i] = 3 / at.area * (4 * moments[i] - (moments[0] + moments[1] + moments[2]));
    if (!jumps[i] || side != 0) continue;
    const double from_tip = std::abs(_course.along(at.x[i]));
    if (from_tip >= _outer || from_tip == 0) continue;
    const double jump =
        cutoff(from_tip).value * _singular.power({from_tip}).front() * _singular.jump();
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
