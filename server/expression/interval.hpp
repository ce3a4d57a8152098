// SPDX-License-Identifier: GPL-3.0-or-later
//
// Intervals of real numbers whose ends are rounded outwards, so that they hold every value that the
// exact operation can have (R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval
// Analysis, 2009).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace anticrack::expression {

struct Interval {
  double low = 0, high = 0;

  bool finite() const noexcept { return std::isfinite(low) && std::isfinite(high); }
  bool holds(double value) const noexcept { return low <= value && value <= high; }
  bool is(double value) const noexcept { return low == value && high == value; }
  double middle() const noexcept { return 0.5 * low + 0.5 * high; }
  /// Half the width, rounded up.
  double radius() const noexcept { return (0.5 * high - 0.5 * low) * (1 + 0x1p-51); }
  /// Greatest absolute value.
  double magnitude() const noexcept { return std::max(std::abs(low), std::abs(high)); }
};

inline constexpr Interval everything{-std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::infinity()};

/// The interval around ends that are wrong by `ulps` units in the last place, or by the smallest
/// normal number; everything, if an end is NaN.
inline Interval outward(double low, double high, double ulps = 1) {
  constexpr double unit = std::numeric_limits<double>::epsilon(),
                   tiny = std::numeric_limits<double>::min(),
                   greatest = std::numeric_limits<double>::max();
  if (!(low <= high)) return everything;
  return {std::min(low, greatest) - (ulps * unit * std::abs(std::min(low, greatest)) + tiny),
          std::max(high, -greatest) + (ulps * unit * std::abs(std::max(high, -greatest)) + tiny)};
}

inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator+(const Interval& a, const Interval& b) {
  if (a.is(0)) return b;
  if (b.is(0)) return a;
  const double low = a.low + b.low, high = a.high + b.high;
  Interval result = outward(low, high);
  if (low == 0) result.low = 0;  // a sum that rounds to 0 is 0
  if (high == 0) result.high = 0;
  return result;
}
inline Interval operator-(const Interval& a, const Interval& b) { return a + -b; }
inline Interval operator*(const Interval& a, const Interval& b) {
  if (a.is(0) || b.is(0)) return {};
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  // An infinite end times an end that is 0 is NaN: nothing is known then.
  if (std::isnan(p + q + r + s) &&
      !(std::isfinite(p) && std::isfinite(q) && std::isfinite(r) && std::isfinite(s)))
    return everything;
  return outward(std::min(std::min(p, q), std::min(r, s)),
                 std::max(std::max(p, q), std::max(r, s)));
}
inline Interval operator*(double factor, const Interval& a) {
  if (factor == 0 || a.is(0)) return {};
  return factor > 0 ? outward(factor * a.low, factor * a.high)
                    : outward(factor * a.high, factor * a.low);
}
inline Interval square(const Interval& a) {
  const double most = a.magnitude(),
               least = a.holds(0) ? 0 : std::min(std::abs(a.low), std::abs(a.high));
  const Interval result = outward(least * least, most * most);
  return {std::max(0.0, result.low), result.high};
}
/// The reciprocal; everything, if the interval holds 0.
inline Interval reciprocal(const Interval& a) {
  return a.holds(0) ? everything : outward(1 / a.high, 1 / a.low);
}

}  // namespace anticrack::expression
