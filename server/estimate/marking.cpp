// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/marking.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "stop/stop.hpp"

namespace anticrack::estimate {
namespace {

constexpr const char* choosing = "choosing which triangles to bisect";

/// Most levels of one stage; more would trust the indicators of a coarse mesh too far.
constexpr double most_levels = 8;

/// The fraction of the sum of the indicators that Doerfler's marking takes.
constexpr double doerfler = 0.5;

/// sqrt(tau), for sum_K eta_K^2 / max(1, eta_K / sqrt(tau)) = target. Found from below in a few
/// steps: the set of triangles that stay whole determines tau.
double root_of_tau(std::span<const double> indicator, double target) {
  for (double root = 0;;) {
    stop::look(choosing);
    double whole = 0;
    double roots = 0;
    for (const double one : indicator) {
      const double eta = std::sqrt(one);
      (eta > root ? roots : whole) += eta > root ? eta : one;
    }
    const double next = roots > 0 ? (target - whole) / roots : 0;
    if (!(next > root)) return root;
    root = next;
  }
}

}  // namespace

std::vector<std::uint8_t> levels(std::span<const double> indicator, double reduction) {
  const double sum = std::accumulate(indicator.begin(), indicator.end(), 0.0);
  std::vector<std::uint8_t> levels(indicator.size(), 0);
  if (!(sum > 0)) return levels;
  const double root = root_of_tau(indicator, sum / reduction);
  for (std::size_t t = 0; t < levels.size(); ++t) {
    stop::look_at_turn<stop::quick>(t, choosing);
    const double pieces = std::sqrt(indicator[t]) / root;
    const double wanted = pieces > 1 ? std::round(std::log2(pieces)) : 0;
    levels[t] = static_cast<std::uint8_t>(std::min(wanted, most_levels));
  }
  std::vector<std::int32_t> order(indicator.size());
  std::iota(order.begin(), order.end(), 0);
  stop::look(choosing);
  const auto of = [&](std::int32_t t) { return indicator[static_cast<std::size_t>(t)]; };
  std::size_t turn = 0;
  std::ranges::sort(order, [&](std::int32_t a, std::int32_t b) {
    stop::look_at_turn<stop::quick>(turn++, choosing);
    return of(a) > of(b) || (of(a) == of(b) && a < b);
  });
  // Triangles that are images under a symmetry differ by rounding only: mark all of them or none.
  constexpr double equal = 1 - 1e-6;
  double marked = 0;
  double last = 0;
  for (const std::int32_t t : order) {
    if (marked >= doerfler * sum && of(t) < equal * last) break;
    last = of(t);
    std::uint8_t& level = levels[static_cast<std::size_t>(t)];
    level = std::max<std::uint8_t>(level, 1);
    marked += of(t);
  }
  return levels;
}

double expected_triangles(std::span<const std::uint8_t> levels) {
  double sum = 0;
  for (const std::uint8_t level : levels) sum += std::exp2(level);
  return sum;
}

}  // namespace anticrack::estimate
