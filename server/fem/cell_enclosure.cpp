// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/cell_enclosure.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace anticrack::fem {

using expression::Enclosure;
using expression::Jet;

Centred::Centred(const std::array<double, 3>& at_x, const std::array<double, 3>& at_y)
    : x((at_x[0] + at_x[1] + at_x[2]) / 3), y((at_y[0] + at_y[1] + at_y[2]) / 3) {
  reach_x = reach_y = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    dx[i] = at_x[i] - x;
    dy[i] = at_y[i] - y;
    reach_x = std::max(reach_x, std::abs(dx[i]));
    reach_y = std::max(reach_y, std::abs(dy[i]));
  }
  area = 0.5 * std::abs((dx[1] - dx[0]) * (dy[2] - dy[0]) - (dy[1] - dy[0]) * (dx[2] - dx[0]));
  // The mean of dx^4 is (sum of dx^2)^2 / 60.
  constexpr double root_of_60 = 7.745966692414834;
  length_x = std::sqrt(12 * xx() / root_of_60);
  length_y = std::sqrt(12 * yy() / root_of_60);
}

double Centred::diameter() const {
  double squared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double p = dx[j] - dx[i], q = dy[j] - dy[i];
    squared = std::max(squared, p * p + q * q);
  }
  return std::sqrt(squared);
}

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Keeps the integral whose radius is less.
void keep_closer(Enclosed& result, double integral, double radius) {
  if (!(radius < result.radius)) return;
  result.integral = integral;
  result.radius = radius;
}

void keep_closer(Modelled& result, const Modelled& other) {
  if (other.radius < result.radius) result = other;
}

Interval box_x(const Centred& at) {
  return {at.x + *std::min_element(at.dx.begin(), at.dx.end()),
          at.x + *std::max_element(at.dx.begin(), at.dx.end())};
}
Interval box_y(const Centred& at) {
  return {at.y + *std::min_element(at.dy.begin(), at.dy.end()),
          at.y + *std::max_element(at.dy.begin(), at.dy.end())};
}

/// Bounds for smooth f: f = f(c) + f_x dx + ... at the centroid c, with the derivatives of the
/// highest known degree enclosed over the whole triangle.
void by_derivatives(Enclosure& f, const Centred& at, const Jet& jet, Enclosed& result) {
  if (jet.order < 1) return;
  const Jet centre = f({at.x, at.x}, {at.y, at.y}, jet.order - 1);
  const auto& c = jet.of;
  const Interval& value = centre.of[0];
  const double off = c[1].magnitude() * at.reach_x + c[2].magnitude() * at.reach_y;
  result.values.low = std::max(result.values.low, value.low - off);
  result.values.high = std::min(result.values.high, value.high + off);
  const double u = at.length_x, v = at.length_y;
  const double first = c[1].radius() * std::sqrt(at.xx()) + c[2].radius() * std::sqrt(at.yy());
  keep_closer(result, at.area * value.middle(), at.area * (value.radius() + first));
  const auto moments = [&](const Jet& slopes, double radius) {
    const double slope_x = slopes.of[1].middle(), slope_y = slopes.of[2].middle();
    keep_closer(result.moments,
                {at.area * value.middle(), at.area * (slope_x * at.xx() + slope_y * at.xy()),
                 at.area * (slope_x * at.xy() + slope_y * at.yy()), radius});
  };
  moments(jet, at.area * (value.radius() + first));
  if (jet.order < 2) return;
  const double slopes = centre.of[1].radius() * std::sqrt(at.xx()) +
                        centre.of[2].radius() * std::sqrt(at.yy()),
               bend =
                   c[3].magnitude() * u * u + c[4].magnitude() * u * v + c[5].magnitude() * v * v;
  moments(centre, at.area * (value.radius() + slopes + bend));
  const auto quadratic = [&](const Jet& by) {
    return by.of[3].middle() * at.xx() + by.of[4].middle() * at.xy() + by.of[5].middle() * at.yy();
  };
  const auto wide = [&](const Jet& by) {
    return by.of[3].radius() * u * u + by.of[4].radius() * u * v + by.of[5].radius() * v * v;
  };
  keep_closer(result, at.area * (value.middle() + quadratic(jet)),
              at.area * (value.radius() + wide(jet)));
  if (jet.order < 3) return;
  double cubic = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double p = at.dx[i], q = at.dy[i];
    cubic += (c[6].middle() * p * p * p + c[7].middle() * p * p * q + c[8].middle() * p * q * q +
              c[9].middle() * q * q * q) /
             30;
  }
  const double rest = c[6].radius() * u * u * u + c[7].radius() * u * u * v +
                      c[8].radius() * u * v * v + c[9].radius() * v * v * v;
  keep_closer(result, at.area * (value.middle() + quadratic(centre) + cubic),
              at.area * (value.radius() + wide(centre) + rest));
}

/// A convex polygon; its points are relative to the centroid of the triangle.
class Polygon {
 public:
  static constexpr std::size_t most = 8;
  Polygon() = default;
  explicit Polygon(const Centred& of) : _count(3) {
    for (std::size_t i = 0; i < 3; ++i) _points[i] = {of.dx[i], of.dy[i]};
  }

  /// The part where value + slope_x dx + slope_y dy < 0.
  Polygon below(double value, double slope_x, double slope_y) const {
    Polygon part;
    const auto at = [&](std::size_t i) {
      return value + slope_x * _points[i][0] + slope_y * _points[i][1];
    };
    for (std::size_t i = 0; i < _count; ++i) {
      const std::size_t j = (i + 1) % _count;
      const double p = at(i), q = at(j);
      if (p < 0) part.add(_points[i]);
      if ((p < 0) != (q < 0)) {
        const double t = p / (p - q);
        part.add({_points[i][0] + t * (_points[j][0] - _points[i][0]),
                  _points[i][1] + t * (_points[j][1] - _points[i][1])});
      }
    }
    return part;
  }

  /// The area, the centroid, and the integrals of dx^2, dx dy and dy^2.
  struct Measure {
    double area = 0, dx = 0, dy = 0, xx = 0, xy = 0, yy = 0;
  };
  Measure measure() const {
    Measure sum;
    for (std::size_t i = 1; i + 1 < _count; ++i) {
      const auto &o = _points[0], &p = _points[i], &q = _points[i + 1];
      const double part =
          0.5 * std::abs((p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]));
      sum.area += part;
      sum.dx += part * (o[0] + p[0] + q[0]) / 3;
      sum.dy += part * (o[1] + p[1] + q[1]) / 3;
      const auto product = [&](std::size_t a, std::size_t b) {
        return part / 12 *
               ((o[a] + p[a] + q[a]) * (o[b] + p[b] + q[b]) + o[a] * o[b] + p[a] * p[b] +
                q[a] * q[b]);
      };
      sum.xx += product(0, 0);
      sum.xy += product(0, 1);
      sum.yy += product(1, 1);
    }
    if (sum.area > 0) {
      sum.dx /= sum.area;
      sum.dy /= sum.area;
    }
    return sum;
  }

 private:
  void add(const std::array<double, 2>& point) {
    if (_count < most) _points[_count++] = point;
  }
  std::array<std::array<double, 2>, most> _points{};
  std::size_t _count = 0;
};

/// Bounds on the two sides of straight lines, which stand for the lines where choices change.
class Sides {
 public:
  Sides(Enclosure& f, const Centred& at) : _f(f), _at(at), _x(box_x(at)), _y(box_y(at)) {}

  void operator()(Enclosed& result) {
    add(Polygon(_at));
    const double radius = _radius + rounding * _largest * _at.area;
    keep_closer(result, _moments.integral, radius);
    _moments.radius = radius;
    keep_closer(result.moments, _moments);
    result.values.low = std::max(result.values.low, _values.low);
    result.values.high = std::min(result.values.high, _values.high);
    if (_beside.low <= _beside.high) result.beside = _beside;
    result.strips = _strips;
  }

 private:
  static constexpr std::size_t most = 4;  // nested choices
  static constexpr double rounding = 1e-15;

  const Jet& in_box(int order) { return _f(_x, _y, order, _taken); }
  const Jet& in_centre(int order) { return _f({_at.x, _at.x}, {_at.y, _at.y}, order, _taken); }

  void add(const Polygon& polygon) {
    const Polygon::Measure own = polygon.measure();
    if (!(own.area > 0)) return;
    const Jet jet = in_box(1);
    if (jet.value().finite()) _largest = std::max(_largest, jet.value().magnitude());
    const std::optional<Enclosure::Choice> choice = _f.choice();
    if (!choice || _taken.size() == most) {
      add_smooth(own, jet);
      return;
    }
    _taken.push_back(*choice);
    in_box(2);
    const Jet g = _f.argument();
    in_centre(1);
    const Jet centre = _f.argument();
    // g is within `away` of a linear function.
    const double u = _at.reach_x, v = _at.reach_y;
    const Interval bent = g.order < 2
                              ? expression::everything
                              : g.of[3] * Interval{0, u * u} + g.of[4] * Interval{-u * v, u * v} +
                                    g.of[5] * Interval{0, v * v};
    const double value = centre.value().middle() + bent.middle(), slope_x = centre.of[1].middle(),
                 slope_y = centre.of[2].middle();
    const double away = centre.value().radius() + centre.of[1].radius() * u +
                        centre.of[2].radius() * v + bent.radius() +
                        4e-16 * (std::abs(value) + std::abs(slope_x) * u + std::abs(slope_y) * v);
    if (centre.order < 1 || !std::isfinite(away) || !std::isfinite(value)) {
      _taken.pop_back();
      add_smooth(own, jet);
      return;
    }
    const Polygon below = polygon.below(value + away, slope_x, slope_y),
                  above = polygon.below(away - value, -slope_x, -slope_y);
    // The centroid of the strip is what the parts beside it leave.
    const Polygon::Measure before = below.measure(), behind = above.measure();
    Polygon::Measure strip;
    strip.area = std::max(0.0, own.area - before.area - behind.area);
    if (strip.area > 0) {
      const auto left = [&](double all, double one, double other) {
        return (own.area * all - before.area * one - behind.area * other) / strip.area;
      };
      strip.dx = std::clamp(left(own.dx, before.dx, behind.dx), -_at.reach_x, _at.reach_x);
      strip.dy = std::clamp(left(own.dy, before.dy, behind.dy), -_at.reach_y, _at.reach_y);
    }
    const Interval beside = _beside;
    add_part(strip, jet.value().middle(), {0, 0}, jet.value().radius(), jet.value());
    _beside = beside;
    _strips += strip.area;
    for (const bool side : {false, true}) {
      _taken.back().above = side;
      add(side ? above : below);
    }
    _taken.pop_back();
  }

  void add_smooth(const Polygon::Measure& own, const Jet& jet) {
    if (jet.order < 1 || !jet.of[1].finite() || !jet.of[2].finite()) {
      add_part(own, jet.value().middle(), {0, 0}, jet.value().radius(), jet.value());
      return;
    }
    const double slope_x = jet.of[1].middle(), slope_y = jet.of[2].middle(),
                 off = jet.of[1].radius() * _at.reach_x + jet.of[2].radius() * _at.reach_y;
    const Interval centre = in_centre(0).value();
    const double farthest =
        jet.of[1].magnitude() * _at.reach_x + jet.of[2].magnitude() * _at.reach_y;
    add_part(own, centre.middle(), {slope_x, slope_y}, centre.radius() + off,
             {std::max(jet.value().low, centre.low - farthest),
              std::min(jet.value().high, centre.high + farthest)});
  }

  /// The values are within `off` of  value + slope . (dx, dy).
  void add_part(const Polygon::Measure& part, double value, const std::array<double, 2>& slope,
                double off, const Interval& values) {
    if (part.area == 0) return;
    _values = hull(_values, values);
    _beside = hull(_beside, values);
    _moments.integral += part.area * (value + slope[0] * part.dx + slope[1] * part.dy);
    _moments.x += part.area * value * part.dx + slope[0] * part.xx + slope[1] * part.xy;
    _moments.y += part.area * value * part.dy + slope[0] * part.xy + slope[1] * part.yy;
    _radius += part.area * off;
  }

  Enclosure& _f;
  const Centred& _at;
  Interval _x, _y;
  std::vector<Enclosure::Choice> _taken;
  Modelled _moments;
  double _radius = 0, _largest = 0;
  Interval _values{infinite, -infinite}, _beside = _values;
  double _strips = 0;
};

}  // namespace

Enclosed enclose(Enclosure& f, const Centred& triangle) {
  const Jet jet = f(box_x(triangle), box_y(triangle), 3);
  const std::optional<Enclosure::Choice> choice = f.choice();
  Enclosed result{0, infinite, jet.value(), jet.value(), 0, {0, 0, 0, infinite}};
  if (jet.value().finite()) {
    const double integral = triangle.area * jet.value().middle(),
                 radius = triangle.area * jet.value().radius();
    keep_closer(result, integral, radius);
    keep_closer(result.moments, {integral, 0, 0, radius});
  }
  if (choice)
    Sides(f, triangle)(result);
  else
    by_derivatives(f, triangle, jet, result);
  if (!choice) result.beside = result.values;
  return result;
}

}  // namespace anticrack::fem
