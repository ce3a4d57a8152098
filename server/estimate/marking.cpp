// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/marking.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace anticrack::estimate {
namespace {

/// Of one stage; more would trust the indicators of a coarse mesh too far.
constexpr double most_levels = 8;

/// Of the sum of the indicators.
constexpr double doerfler = 0.5;

}  // namespace

std::vector<std::uint8_t> levels(std::span<const double> indicator, double reduction) {
  double sum = 0;
  double roots = 0;
  for (const double one : indicator) {
    sum += one;
    roots += std::sqrt(one);
  }
  std::vector<std::uint8_t> levels(indicator.size(), 0);
  if (!(sum > 0)) return levels;
  const double root_of_tau = sum / (reduction * roots);
  for (std::size_t t = 0; t < levels.size(); ++t) {
    const double pieces = std::sqrt(indicator[t]) / root_of_tau;
    const double wanted = pieces > 1 ? std::round(std::log2(pieces)) : 0;
    levels[t] = static_cast<std::uint8_t>(std::min(wanted, most_levels));
  }
  std::vector<std::int32_t> order(indicator.size());
  std::iota(order.begin(), order.end(), 0);
  const auto of = [&](std::int32_t t) { return indicator[static_cast<std::size_t>(t)]; };
  std::ranges::sort(order, [&](std::int32_t a, std::int32_t b) {
    return of(a) > of(b) || (of(a) == of(b) && a < b);
  });
  double marked = 0;
  for (const std::int32_t t : order) {
    if (marked >= doerfler * sum) break;
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
