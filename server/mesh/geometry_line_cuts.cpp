// SPDX-License-Identifier: GPL-3.0-or-later
//
// Measures lines, and cuts them into chords.
#include <algorithm>
#include <cmath>

#include "mesh/geometry_line.hpp"

namespace anticrack::mesh {
namespace {

constexpr int steps_at_least = 128;

/// Angle from one direction to another, without its sign.
double turn(const Point& a, const Point& b) {
  return std::abs(std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]));
}

}  // namespace

double Tips::part(double k, double n) const noexcept {
  const double x = k / n, y = 1 - x;
  if (count() == 2) return x < 0.5 ? 2 * x * x : 1 - 2 * y * y;
  return at_from ? x * x : at_to ? 1 - y * y : x;
}

double Line::along(double from, double to, double part) const {
  const auto wrapped = [&](double t) { return at(t >= _spans && _closed ? t - _spans : t); };
  std::vector<double> t{from};
  const int each = samples_in_span();
  for (double next = std::floor(from * each) + 1; next < to * each; ++next)
    t.push_back(next / each);
  t.push_back(to);
  std::vector<double> sum{0};
  for (std::size_t i = 1; i < t.size(); ++i)
    sum.push_back(sum.back() + distance(wrapped(t[i - 1]), wrapped(t[i])));
  const double wanted = part * sum.back();
  std::size_t i = 1;
  while (i + 1 < sum.size() && sum[i] < wanted) ++i;
  return t[i - 1] + (t[i] - t[i - 1]) * (wanted - sum[i - 1]) / (sum[i] - sum[i - 1]);
}

/// The cumulated number of chords after each of `steps` equal pieces of the parameter.
std::vector<double> Line::measure(double from, double to, const ChordRule& rule, int steps) const {
  std::vector<double> sum{0};
  sum.reserve(static_cast<std::size_t>(steps) + 1);
  Point before = at(from);
  // a little inside, so that a corner between spans does not count
  Point direction = derivative(from + 1e-9 * (to - from));
  for (int i = 1; i <= steps; ++i) {
    const double t = from + (to - from) * i / steps;
    const Point here = at(t);
    const Point heading = derivative(t - 1e-9 * (to - from));
    sum.push_back(sum.back() + std::max(distance(before, here) / rule.size,
                                        turn(direction, heading) / rule.turn));
    before = here;
    direction = heading;
  }
  return sum;
}

double Line::chords_between(double from, double to, const ChordRule& rule) const {
  return measure(from, to, rule, steps_at_least).back();
}

std::vector<double> Line::cuts_between(double from, double to, const ChordRule& rule,
                                       Tips tips) const {
  const double expected = std::ceil(chords_between(from, to, rule));
  const int steps = steps_at_least + 4 * static_cast<int>(expected);
  const std::vector<double> sum = measure(from, to, rule, steps);
  const double chords = (tips.count() > 0 ? 2 : 1) * sum.back();
  const auto pieces = static_cast<int>(std::ceil(chords - 1e-6));
  std::vector<double> cuts;
  cuts.reserve(static_cast<std::size_t>(std::max(0, pieces)));
  std::size_t i = 1;
  for (int k = 1; k < pieces; ++k) {
    const double wanted = sum.back() * tips.part(k, pieces);
    while (sum[i] < wanted) ++i;
    const double part = (wanted - sum[i - 1]) / (sum[i] - sum[i - 1]);
    cuts.push_back(from + (to - from) * (static_cast<double>(i - 1) + part) / steps);
  }
  return cuts;
}

}  // namespace anticrack::mesh
