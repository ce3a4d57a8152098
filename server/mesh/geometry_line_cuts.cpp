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

// Towards a tip there are 1 / (at_tip + growth c) chords for each of the rule, c of which lie
// between, where that is above 1.
constexpr double at_tip = 0.03, growth = 0.2, until_rule = (1 - at_tip) / growth;

double count_from_tip(double c) {
  const double near = std::log1p(growth * std::min(c, until_rule) / at_tip) / growth;
  return near + std::max(0.0, c - until_rule);
}

double reach_from_tip(double count) {
  const double near = count_from_tip(until_rule);
  return std::expm1(growth * std::min(count, near)) * at_tip / growth + std::max(0.0, count - near);
}

}  // namespace

double Tips::count(double chords) const noexcept {
  if (at_from && at_to) return 2 * count_from_tip(chords / 2);
  return at_from || at_to ? count_from_tip(chords) : chords;
}

double Tips::reach(double k, double chords) const noexcept {
  const double all = count(chords);
  if (at_from && (!at_to || k < all / 2)) return reach_from_tip(k);
  return at_to ? chords - reach_from_tip(all - k) : k;
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
  const double chords = tips.count(sum.back());
  const auto pieces = static_cast<int>(std::ceil(chords - 1e-6));
  std::vector<double> cuts;
  cuts.reserve(static_cast<std::size_t>(std::max(0, pieces)));
  std::size_t i = 1;
  for (int k = 1; k < pieces; ++k) {
    const double wanted = tips.reach(chords * k / pieces, sum.back());
    while (sum[i] < wanted) ++i;
    const double part = (wanted - sum[i - 1]) / (sum[i] - sum[i - 1]);
    cuts.push_back(from + (to - from) * (static_cast<double>(i - 1) + part) / steps);
  }
  return cuts;
}

}  // namespace anticrack::mesh
