// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/cut_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/break_forecast.hpp"
#include "fem/piecewise_quadrature.hpp"

namespace anticrack::fem {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Width to which a break is located, as part of the triangle's size: not below rounding.
double resolution(const Triangle& triangle, double wanted, double roundings) {
  return std::max(wanted, roundings * epsilon * magnitude(triangle) / longest_edge(triangle));
}

Point centroid(const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return {a.x + ((b.x - a.x) + (c.x - a.x)) / 3, a.y + ((b.y - a.y) + (c.y - a.y)) / 3};
}

double distance(const Point& a, const Point& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

/// Coordinates (s, t) about the centroid, in units of the longest edge, s along a chord. The field
/// is evaluated drawn in: at (s, t) towards the centroid.
class Frame {
 public:
  Frame(const Triangle& triangle, const Point& from, const Point& to)
      : _origin(centroid(triangle)),
        _size(longest_edge(triangle)),
        _drawn(_size * drawn_in(triangle)) {
    const double chord = distance(from, to);
    _along = {(to.x - from.x) / chord, (to.y - from.y) / chord};
  }

  Point to_plane(double s, double t) const {
    return {_origin.x + _drawn * (s * _along.x - t * _along.y),
            _origin.y + _drawn * (s * _along.y + t * _along.x)};
  }

  Point from_plane(const Point& p) const {
    const double dx = (p.x - _origin.x) / _size, dy = (p.y - _origin.y) / _size;
    return {dx * _along.x + dy * _along.y, dy * _along.x - dx * _along.y};
  }

  double size() const { return _size; }

 private:
  Point _origin;
  double _size;
  double _drawn;
  Point _along{};
};

struct Chord {
  Point from;
  Point to;
};

Chord farthest(const std::vector<Point>& points) {
  Chord best{points.front(), points.front()};
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      if (distance(points[i], points[j]) > distance(best.from, best.to)) {
        best = {points[i], points[j]};
      }
    }
  }
  return best;
}

/// A direction that the break follows as far as the edges tell.
Chord sweep_direction(const Triangle& triangle, const std::array<EdgeBreaks, 3>& edges) {
  std::vector<Point> jumps, all;
  std::size_t last = 0, longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    jumps.insert(jumps.end(), edges[i].jumps.begin(), edges[i].jumps.end());
    all.insert(all.end(), edges[i].kinks.begin(), edges[i].kinks.end());
    last = edges[i].jumps.empty() && edges[i].kinks.empty() ? last : i;
    if (distance(triangle[i], triangle[(i + 1) % 3]) >
        distance(triangle[longest], triangle[(longest + 1) % 3])) {
      longest = i;
    }
  }
  all.insert(all.end(), jumps.begin(), jumps.end());
  const double too_short = 1e-9 * longest_edge(triangle);
  for (const std::vector<Point>* points : {&jumps, &all}) {
    if (points->size() >= 2) {
      const Chord chord = farthest(*points);
      if (distance(chord.from, chord.to) > too_short) {
        return chord;
      }
    }
  }
  if (all.size() == 1) {  // the break leaves through the opposite corner, between two edges
    return {all.front(), triangle[(last + 2) % 3]};
  }
  return {triangle[longest], triangle[(longest + 1) % 3]};
}

/// The inner integral: over the line s = const of the triangle.
class Line {
 public:
  Line(const Frame& frame, const std::array<Point, 3>& corners, BreakForecast& forecast,
       PiecewiseControl control, CountedField& field)
      : _frame(frame), _corners(corners), _forecast(forecast), _control(control), _field(field) {}

  /// int f dt and int t f dt.
  Reading<2> operator()(double s) {
    const auto [low, high] = clip(s);
    if (!(high - low > 4 * _control.resolution)) {
      const double middle = 0.5 * (low + high);
      const double whole = high > low ? (high - low) * value(s, middle) : 0;
      return {{whole, middle * whole}, 0};
    }
    std::vector<double> ends{low};
    for (const double end : _forecast.divide(s)) {
      if (!_field.exhausted() && end > ends.back() + 4 * _control.resolution &&
          end < high - 4 * _control.resolution) {
        ends.push_back(end);
      }
    }
    ends.push_back(high);
    const auto along = [this, s](double t) { return Reading<1>{{value(s, t)}, 0}; };
    const PiecewiseIntegral<1> found =
        PiecewiseQuadrature<1, decltype(along)>(along, _field, _control)(ends);
    _forecast.record(found.jumps);
    _cut = _cut || !found.jumps.empty() || !found.kinks.empty();
    return {{found.zeroth[0], found.first[0]}, found.error};
  }

  bool cut() const { return _cut; }

 private:
  double value(double s, double t) {
    const Point at = _frame.to_plane(s, t);
    return _field(at.x, at.y);
  }

  std::array<double, 2> clip(double s) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto meet = [&](double t) {
      low = std::min(low, t);
      high = std::max(high, t);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& a = _corners[i];
      const Point& b = _corners[(i + 1) % 3];
      if (a.x == s) {
        meet(a.y);
      }
      if ((a.x < s && s < b.x) || (b.x < s && s < a.x)) {
        meet(a.y + (s - a.x) / (b.x - a.x) * (b.y - a.y));
      }
    }
    return {low, high};
  }

  const Frame& _frame;
  const std::array<Point, 3>& _corners;
  BreakForecast& _forecast;
  PiecewiseControl _control;
  CountedField& _field;
  bool _cut = false;
};

/// At the corners, and on both sides of the breaks on the edges: a line right through such a point
/// may see either side of the jump that ends there, and what begins behind it would be missed.
std::vector<double> panel_ends(const Frame& frame, const std::array<Point, 3>& corners,
                               const std::array<EdgeBreaks, 3>& edges, double least) {
  const auto [low, high] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  std::vector<double> inside{corners[0].x, corners[1].x, corners[2].x};
  for (const EdgeBreaks& edge : edges) {
    for (const std::vector<Point>* points : {&edge.jumps, &edge.kinks}) {
      for (const Point& point : *points) {
        const double s = frame.from_plane(point).x;
        inside.push_back(s - 4 * least);
        inside.push_back(s + 4 * least);
      }
    }
  }
  std::sort(inside.begin(), inside.end());
  std::vector<double> ends{low};
  for (const double s : inside) {
    if (s > ends.back() + least && s < high - least) {
      ends.push_back(s);
    }
  }
  ends.push_back(high);
  return ends;
}

std::array<std::vector<Point>, 3> edge_jumps(const Frame& frame,
                                             const std::array<EdgeBreaks, 3>& edges) {
  std::array<std::vector<Point>, 3> jumps;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const Point& point : edges[i].jumps) {
      jumps[i].push_back(frame.from_plane(point));
    }
  }
  return jumps;
}

}  // namespace

EdgeBreaks scan_edge(const Triangle& triangle, std::size_t edge, double tolerance,
                     CountedField& field) {
  constexpr std::size_t panels = 16;
  const Point from = triangle[edge], to = triangle[(edge + 1) % 3];
  const Point origin = centroid(triangle);
  const double shrink = drawn_in(triangle);
  const auto point = [&](double part) {
    const double x = from.x + part * (to.x - from.x), y = from.y + part * (to.y - from.y);
    return Point{origin.x + shrink * (x - origin.x), origin.y + shrink * (y - origin.y)};
  };
  const auto along = [&](double part) {
    const Point at = point(part);
    return Reading<1>{{field(at.x, at.y)}, 0};
  };
  std::array<double, panels + 1> ends{};
  for (std::size_t i = 0; i <= panels; ++i) {
    ends[i] = static_cast<double>(i) / panels;
  }
  const PiecewiseControl control{tolerance, resolution(triangle, 1e-13, 4)};
  const PiecewiseIntegral<1> found =
      PiecewiseQuadrature<1, decltype(along)>(along, field, control)(ends);
  EdgeBreaks breaks;
  // Where the point itself is, not where it was evaluated: the frame's coordinates are undrawn.
  const auto undrawn = [&](double part) {
    return Point{from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
  };
  for (const double part : found.jumps) {
    breaks.jumps.push_back(undrawn(part));
  }
  for (const double part : found.kinks) {
    breaks.kinks.push_back(undrawn(part));
  }
  return breaks;
}

CutTriangle integrate_cut_triangle(const Triangle& triangle, const std::array<EdgeBreaks, 3>& edges,
                                   double tolerance, CountedField& field) {
  const Chord chord = sweep_direction(triangle, edges);
  const Frame frame(triangle, chord.from, chord.to);
  const std::array<Point, 3> corners{frame.from_plane(triangle[0]), frame.from_plane(triangle[1]),
                                     frame.from_plane(triangle[2])};
  const double scale = frame.size() * frame.size();
  // Lines across are coarser than points on them: a jump along a line must not be met by rounding.
  const double across = resolution(triangle, 1e-12, 32);
  const std::vector<double> ends = panel_ends(frame, corners, edges, across);
  BreakForecast forecast(edge_jumps(frame, edges));
  Line line(
      frame, corners, forecast,
      {0.1 * tolerance / scale / (ends.back() - ends.front()), resolution(triangle, 1e-13, 4)},
      field);
  // A jump may be plain on one side of a panel's end and hidden on the other: let all ends have
  // been seen before the first one counts.
  for (const double s : ends) {
    if (!field.exhausted()) {
      line(s);
    }
  }
  const PiecewiseIntegral<2> found =
      PiecewiseQuadrature<2, Line>(line, field, {0.5 * tolerance / scale, across})(ends);

  CutTriangle result;
  result.error = scale * found.error;
  result.cut = line.cut() || !found.jumps.empty() || !found.kinks.empty();
  const double zeroth = found.zeroth[0], first_s = found.first[0], first_t = found.zeroth[1];
  const double doubled_area = 2 * area(triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& j = corners[(i + 1) % 3];
    const Point& k = corners[(i + 2) % 3];
    const double integral =
        zeroth * (j.x * k.y - k.x * j.y) + first_s * (j.y - k.y) + first_t * (k.x - j.x);
    result.nodal[i] = scale * scale * integral / doubled_area;
  }
  return result;
}

}  // namespace anticrack::fem
