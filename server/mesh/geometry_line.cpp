// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace anticrack::mesh {
namespace {

constexpr int samples_a_span = 32;
constexpr int samples_half_an_arc = 128;

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1]; }

}  // namespace

Line::Box Line::around(const Box& a, const Box& b) noexcept {
  Box both = a;
  for (std::size_t k = 0; k < 2; ++k) {
    both.diagonal.a[k] = std::min(a.diagonal.a[k], b.diagonal.a[k]);
    both.diagonal.b[k] = std::max(a.diagonal.b[k], b.diagonal.b[k]);
  }
  both.slack = std::max(a.slack, b.slack);
  return both;
}

Line::Line(Shape shape, bool closed, std::vector<Point> vertices)
    : _shape(shape), _closed(closed), _vertices(std::move(vertices)) {
  _spans = static_cast<int>(_vertices.size()) - (closed ? 0 : 1);
}

Line Line::polyline(std::vector<Point> points, bool closed) {
  Line line(Shape::polyline, closed, std::move(points));
  line.sample();
  return line;
}

Line Line::arc(const Point& a, const Point& b, const Point& c) {
  Line line(Shape::arc, false, {a, b, c});
  const Point u = minus(b, a);
  const Point v = minus(c, a);
  const double twice = 2 * (u[0] * v[1] - u[1] * v[0]);
  const Point to_centre{(v[1] * dot(u, u) - u[1] * dot(v, v)) / twice,
                        (u[0] * dot(v, v) - v[0] * dot(u, u)) / twice};
  line._centre = {a[0] + to_centre[0], a[1] + to_centre[1]};
  line._radius = std::hypot(to_centre[0], to_centre[1]);
  const bool left = twice > 0;  // a, b, c counterclockwise
  for (const Point& vertex : line._vertices) {
    const Point spoke = minus(vertex, line._centre);
    double angle = std::atan2(spoke[1], spoke[0]);
    if (!line._angles.empty()) {
      while (left && angle <= line._angles.back()) angle += 2 * std::numbers::pi;
      while (!left && angle >= line._angles.back()) angle -= 2 * std::numbers::pi;
    }
    line._angles.push_back(angle);
  }
  line.sample();
  return line;
}

Line Line::circle(const Point& centre, double radius) {
  const auto [x, y] = centre;
  Line line(Shape::circle, true,
            {{x, y + radius}, {x + radius, y}, {x, y - radius}, {x - radius, y}});
  line._centre = centre;
  line._radius = radius;
  for (int quarter = 1; quarter >= -3; --quarter)
    line._angles.push_back(quarter * std::numbers::pi / 2);
  line.sample();
  return line;
}

Line Line::spline(std::vector<Point> points, bool closed) {
  Line line(Shape::spline, closed, std::move(points));
  const auto n = static_cast<int>(line._vertices.size());
  // beyond an open end the line goes straight on
  const auto point = [&](int i) -> Point {
    if (closed) return line._vertices[static_cast<std::size_t>((i + n) % n)];
    const auto mirrored = [&](int end, int next) -> Point {
      const Point& e = line._vertices[static_cast<std::size_t>(end)];
      const Point& q = line._vertices[static_cast<std::size_t>(next)];
      return {2 * e[0] - q[0], 2 * e[1] - q[1]};
    };
    if (i < 0) return mirrored(0, 1);
    if (i >= n) return mirrored(n - 1, n - 2);
    return line._vertices[static_cast<std::size_t>(i)];
  };
  line._out.reserve(static_cast<std::size_t>(line._spans));
  line._in.reserve(static_cast<std::size_t>(line._spans));
  for (int k = 0; k < line._spans; ++k) {
    const std::array<Point, 4> p{point(k - 1), point(k), point(k + 1), point(k + 2)};
    const double d0 = std::sqrt(distance(p[0], p[1]));
    const double d1 = std::sqrt(distance(p[1], p[2]));
    const double d2 = std::sqrt(distance(p[2], p[3]));
    Point out{};
    Point in{};
    for (std::size_t i = 0; i < 2; ++i) {
      out[i] = d1 * ((p[1][i] - p[0][i]) / d0 - (p[2][i] - p[0][i]) / (d0 + d1) +
                     (p[2][i] - p[1][i]) / d1);
      in[i] = d1 * ((p[2][i] - p[1][i]) / d1 - (p[3][i] - p[1][i]) / (d1 + d2) +
                    (p[3][i] - p[2][i]) / d2);
    }
    line._out.push_back(out);
    line._in.push_back(in);
  }
  line.sample();
  return line;
}

int Line::samples_in_span() const noexcept {
  switch (_shape) {
    case Shape::arc:
    case Shape::circle:
      return samples_half_an_arc;
    case Shape::spline:
      return samples_a_span;
    case Shape::polyline:
    case Shape::segment:
      break;
  }
  return 1;
}

Line::Box Line::box_of(std::size_t first, std::size_t last) const noexcept {
  Box box{{_samples[first].p, _samples[first].p}, 0};
  for (std::size_t i = first + 1; i <= last; ++i) {
    const Point& p = _samples[i].p;
    for (std::size_t k = 0; k < 2; ++k) {
      box.diagonal.a[k] = std::min(box.diagonal.a[k], p[k]);
      box.diagonal.b[k] = std::max(box.diagonal.b[k], p[k]);
    }
  }
  const auto each = static_cast<std::size_t>(samples_in_span());
  for (std::size_t span = first / each; span * each < last; ++span)
    box.slack = std::max(box.slack, bulge(static_cast<int>(span)));
  return box;
}

/// Bound of the distance of a span's curve from the chords of its samples: h^2/8 times the largest
/// second derivative, which is linear within a span of a spline.
double Line::bulge(int k) const noexcept {
  const double h = 1.0 / samples_in_span();
  if (straight()) return 0;
  if (!_angles.empty()) return _radius * sweep(k) * sweep(k) * h * h / 8;
  const Point chord = minus(vertex(k + 1), vertex(k));
  const Point& out = _out[static_cast<std::size_t>(k)];
  const Point& in = _in[static_cast<std::size_t>(k)];
  const double begin =
      std::hypot(6 * chord[0] - 4 * out[0] - 2 * in[0], 6 * chord[1] - 4 * out[1] - 2 * in[1]);
  const double end =
      std::hypot(2 * out[0] + 4 * in[0] - 6 * chord[0], 2 * out[1] + 4 * in[1] - 6 * chord[1]);
  return std::max(begin, end) * h * h / 8;
}

void Line::sample() {
  const int each = samples_in_span();
  _samples.reserve(static_cast<std::size_t>(_spans * each) + 1);
  for (int i = 0; i <= _spans * each; ++i) {
    const double t = static_cast<double>(i) / each;
    _samples.push_back({t, at(t)});
    if (i > 0) _length += distance(_samples[_samples.size() - 2].p, _samples.back().p);
  }
  const auto spans = static_cast<std::size_t>(_spans);
  const auto step = static_cast<std::size_t>(each);
  _boxes.resize(2 * spans);
  for (std::size_t k = 0; k < spans; ++k) _boxes[spans + k] = box_of(k * step, (k + 1) * step);
  for (std::size_t node = spans; node-- > 1;)
    _boxes[node] = around(_boxes[2 * node], _boxes[2 * node + 1]);
  _box = _boxes[1];
}

int Line::span_of(double t) const noexcept {
  return std::clamp(static_cast<int>(std::floor(t)), 0, _spans - 1);
}

Point Line::vertex(int k) const noexcept {
  return _vertices[static_cast<std::size_t>(k) % _vertices.size()];
}

double Line::sweep(int k) const noexcept {
  const auto span = static_cast<std::size_t>(k);
  return _angles[span + 1] - _angles[span];
}

double Line::on_line(double t) const noexcept {
  if (!_closed) return std::clamp(t, 0.0, static_cast<double>(_spans));
  if (t < 0) t += _spans;
  return t >= _spans ? t - _spans : t;
}

Bend Line::bend(int k) const noexcept {
  const auto span = static_cast<std::size_t>(k);
  Bend bend{.a = vertex(k), .b = vertex(k + 1)};
  if (!_angles.empty()) {
    bend.centre = _centre;
    bend.radius = _radius;
    bend.angle = _angles[span];
    bend.sweep = sweep(k);
  } else {
    bend.out = _out[span];
    bend.in = _in[span];
  }
  return bend;
}

Point Line::at(double t) const noexcept {
  const int k = span_of(t);
  const double u = t - k;
  if (!straight()) return bend(k).at(u);
  const Point a = vertex(k);
  const Point b = vertex(k + 1);
  if (u <= 0) return a;
  if (u >= 1) return b;
  return {a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1])};
}

Point Line::derivative(double t) const noexcept {
  const int k = span_of(t);
  return straight() ? minus(vertex(k + 1), vertex(k)) : bend(k).derivative(t - k);
}

/// The parameter of the point nearest to `p` between two samples: starts on their chord, then
/// applies Newton's method to (c - p).c' without curvature in the slope, exact near the line.
double Line::closest(const Point& p, const Sample& low, const Sample& high) const noexcept {
  double t = low.t + (high.t - low.t) * nearest(p, Segment{low.p, high.p});
  for (int i = 0; i < 4; ++i) {
    const Point d = derivative(t);
    const double square = dot(d, d);
    if (square == 0) break;
    t = std::clamp(t - dot(minus(at(t), p), d) / square, low.t, high.t);
  }
  return t;
}

/// As locate(), in what lies near the box of the whole line.
std::optional<double> Line::search(const Point& p, double tolerance) const {
  // An arc is off its circle by rounding alone.
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * _radius;
  if (!_angles.empty() && std::abs(distance(p, _centre) - _radius) > 2 * tolerance + rounding)
    return std::nullopt;
  double best = 0;
  double off = std::numeric_limits<double>::infinity();
  const auto step = static_cast<std::size_t>(samples_in_span());
  const auto try_span = [&](std::size_t k, double slack) {
    for (std::size_t i = k * step + 1; i <= (k + 1) * step; ++i) {
      const Segment chord{_samples[i - 1].p, _samples[i].p};
      if (!boxes_meet(chord, {p, p}, tolerance + slack)) continue;
      const double t = straight() ? _samples[i - 1].t + nearest(p, chord)
                                  : closest(p, _samples[i - 1], _samples[i]);
      const double d = straight() ? distance(p, chord) : distance(p, at(t));
      if (d > off || (d == off && t >= best)) continue;
      off = d;
      best = t;
    }
  };
  const auto spans = static_cast<std::size_t>(_spans);
  std::array<std::size_t, 64> open{1};  // stack of nodes; children replace their parent
  for (std::size_t count = 1; count > 0;) {
    const std::size_t node = open[--count];
    const Box& box = _boxes[node];
    if (!near(box, p, tolerance)) continue;
    if (node >= spans) {
      try_span(node - spans, box.slack);
      continue;
    }
    open[count++] = 2 * node;
    open[count++] = 2 * node + 1;
  }
  if (off > tolerance) return std::nullopt;
  const double whole = std::round(best);
  if (distance(p, at(whole)) <= tolerance) best = whole;
  if (_closed && best >= _spans) best = 0;
  return best;
}

double Line::distance_to(const Point& p) const noexcept {
  double off = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < _samples.size(); ++i)
    off = std::min(off, distance(p, Segment{_samples[i - 1].p, _samples[i].p}));
  return off;
}

}  // namespace anticrack::mesh
