// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_intervals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "mesh/at.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

constexpr int paper_intervals = 80;

void share(const Plan& plan, const std::vector<PlannedCurve*>& curves) {
  if (curves.empty()) return;
  std::vector<double> lengths;
  lengths.reserve(curves.size());
  for (const PlannedCurve* curve : curves) lengths.push_back(length_of(plan, *curve));
  const std::vector<int> shares = apportion(lengths, paper_intervals);
  for (std::size_t i = 0; i < curves.size(); ++i) curves[i]->intervals = shares[i];
}

}  // namespace

double length_of(const Plan& plan, const PlannedCurve& curve) noexcept {
  return distance(plan.points[at(curve.a)], plan.points[at(curve.b)]);
}

void set_paper_intervals(Plan& plan) {
  std::vector<PlannedCurve*> glue;
  std::vector<PlannedCurve*> rest;
  std::array<std::vector<PlannedCurve*>, 2> outer;
  for (PlannedCurve& curve : plan.curves)
    if (curve.role == Role::interface)
      (curve.kind == Kind::glue ? glue : rest).push_back(&curve);
    else
      outer[at(curve.left)].push_back(&curve);
  share(plan, glue);
  share(plan, rest);
  for (const auto& curves : outer) share(plan, curves);
}

void set_intervals(Plan& plan, double size) {
  for (PlannedCurve& curve : plan.curves) {
    // a length that is a whole number of sizes but for rounding is cut into just as many
    curve.intervals =
        static_cast<int>(std::max(1.0, std::ceil(length_of(plan, curve) / size - 1e-9)));
  }
}

std::vector<int> apportion(std::span<const double> lengths, int total) {
  const std::size_t k = lengths.size();
  const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  std::vector<int> shares(k, 1);
  std::vector<double> owed(k, 0.0);  // what a curve's quota exceeds its share by
  int left = total;
  for (std::size_t i = 0; i < k; ++i) {
    const double quota = total * (lengths[i] / sum);
    // a quota that is a whole number but for rounding counts as one
    shares[i] = std::max(1, static_cast<int>(std::floor(quota + 1e-9)));
    owed[i] = quota - shares[i];
    left -= shares[i];
  }
  std::vector<std::size_t> order(k);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return owed[a] > owed[b] + 1e-9; });
  for (std::size_t i = 0; left > 0; i = (i + 1) % k, --left) ++shares[order[i]];
  // curves raised to one interval are paid for by those that have most above their quota
  while (left < 0) {
    std::size_t richest = k;
    for (std::size_t i = 0; i < k; ++i) {
      if (shares[i] < 2) continue;
      const auto above = [&](std::size_t j) { return shares[j] - total * (lengths[j] / sum); };
      if (richest == k || above(i) > above(richest) + 1e-9) richest = i;
    }
    if (richest == k) break;
    --shares[richest];
    ++left;
  }
  return shares;
}

}  // namespace anticrack::mesh
