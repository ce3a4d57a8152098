// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/coarsening.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/at.hpp"

namespace anticrack::mesher {
namespace {

/// Least triangles of a coarse mesh: with so many, shapes are as good as those of a finer mesh.
constexpr double coarse_triangles = 10'000;

/// By which fraction halving may make more triangles than meshing at once.
constexpr double most_in_excess = 0.05;

double interval(const mesh::Plan& plan, const mesh::PlannedCurve& curve) {
  const mesh::Point& a = plan.points[at(curve.a)];
  const mesh::Point& b = plan.points[at(curve.b)];
  return std::hypot(b[0] - a[0], b[1] - a[1]) / curve.intervals;
}

double longest_interval(const mesh::Plan& plan) {
  double longest = 0;
  for (const mesh::PlannedCurve& curve : plan.curves)
    longest = std::max(longest, interval(plan, curve));
  return longest;
}

/// The intervals of a curve in the coarse mesh: one in place of `parts`. Intervals much shorter
/// than the `longest` ones are so short because of what is near them, and stay.
int coarse_intervals(const mesh::Plan& plan, const mesh::PlannedCurve& curve, double longest,
                     int parts) {
  if (interval(plan, curve) < longest / 2) return curve.intervals;
  return (curve.intervals + parts - 1) / parts;
}

/// An estimate of how many more triangles halving makes along all curves and around them. Edges
/// that are shorter by a factor r grow by `growth` per length away from the curve: a band on both
/// sides of it and discs around its ends have more triangles.
double excess(const mesh::Plan& plan, int halvings) {
  const int parts = 1 << halvings;
  const double triangle = std::sqrt(3.0) / 4;  // area of an equilateral one with edge length 1
  const double longest = longest_interval(plan);
  double coarse = 0;
  for (const mesh::PlannedCurve& curve : plan.curves) {
    const int intervals = coarse_intervals(plan, curve, longest, parts);
    const double r = static_cast<double>(intervals) * parts / curve.intervals;
    if (r == 1) continue;
    coarse += intervals * 2 * (1 - 1 / r) / (triangle * plan.growth) +
              2 * std::numbers::pi * std::log(r) / (triangle * plan.growth * plan.growth);
  }
  return coarse * parts * parts;
}

}  // namespace

int halvings(const mesh::Plan& plan) {
  const auto expected = static_cast<double>(plan.triangles);
  int most = 0;
  while (expected >= std::pow(4, most + 1) * coarse_triangles) ++most;
  while (most > 0 && excess(plan, most) > most_in_excess * expected) --most;
  return most;
}

mesh::Plan coarsened(mesh::Plan plan, int halvings) {
  const double longest = longest_interval(plan);
  for (mesh::PlannedCurve& curve : plan.curves)
    curve.intervals = coarse_intervals(plan, curve, longest, 1 << halvings);
  return plan;
}

}  // namespace anticrack::mesher
