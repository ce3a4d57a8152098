// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_network.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/at.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

constexpr double smallest_angle = std::numbers::pi / 180;

class Meetings {
 public:
  Meetings(const Network& network, std::size_t most)
      : _network(network), _tolerance(network.tolerance), _most(most) {}

  void meet(const Chord& s, const Chord& t) {
    if (s.line == t.line)
      same_line(s, t);
    else if (s.line > t.line)
      two_lines(t, s);
    else
      two_lines(s, t);
  }

  Segment segment(const Chord& chord) const {
    return {_network.points[at(chord.a)], _network.points[at(chord.b)]};
  }
  std::vector<Crossing> take() { return std::move(_crossings); }

 private:
  const NetworkLine& line(const Chord& chord) const { return _network.lines[at(chord.line)]; }
  const Point& point(int i) const { return _network.points[at(i)]; }

  static int shared(const Chord& s, const Chord& t) {
    if (s.a == t.a || s.a == t.b) return s.a;
    if (s.b == t.a || s.b == t.b) return s.b;
    return -1;
  }
  static int other(const Chord& chord, int end) { return chord.a == end ? chord.b : chord.a; }

  bool on_one_another(const Chord& s, const Chord& t, int common) const {
    return distance(point(other(s, common)), segment(t)) <= _tolerance ||
           distance(point(other(t, common)), segment(s)) <= _tolerance;
  }
  /// Direction of the line where the chord leaves `end`: the tangent of a curve, not the chord.
  Point direction(const Chord& chord, int end) const {
    const Line& on = line(chord).line;
    if (on.straight()) {
      const Point& o = point(end);
      const Point& p = point(other(chord, end));
      return {p[0] - o[0], p[1] - o[1]};
    }
    if (end == chord.a) return on.derivative(chord.from);
    const double to = on.closed() && chord.to >= on.spans() ? chord.to - on.spans() : chord.to;
    const Point d = on.derivative(to);
    return {-d[0], -d[1]};
  }
  static double angle(const Point& p, const Point& q) {
    return std::abs(std::atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]));
  }

  void same_line(const Chord& s, const Chord& t) const {
    const Field& field = line(s).field;
    const int common = shared(s, t);
    const bool follow = s.b == t.a || t.b == s.a;
    if (common >= 0 && follow) {
      const bool both = other(s, common) == other(t, common);
      if (!both && !on_one_another(s, t, common)) return;
      refuse(field, field, " folds back on itself at ", shown(point(common)));
    }
    if (common < 0 && distance(segment(s), segment(t)) > _tolerance) return;
    refuse(field, field, " crosses or touches itself near ", shown(segment(s).a),
           "; cut it into several interfaces");
  }

  void two_lines(const Chord& s, const Chord& t) {
    const int common = shared(s, t);
    if (at(t.line) < _network.boundary) return between_boundaries(s, t, common);
    if (at(s.line) < _network.boundary) return against_boundary(s, t, common);
    if (common < 0) {
      if (distance(segment(s), segment(t)) <= _tolerance) cross(s, t);
      return;
    }
    const Field& field = line(t).field;
    if (other(s, common) == other(t, common) || on_one_another(s, t, common)) {
      refuse(field, field, " and ", line(s).field, " run along each other from ",
             shown(point(common)), " on; leave that stretch out of one of them");
    }
    check_angle(s, t, common);
  }

  void check_angle(const Chord& s, const Chord& t, int common) const {
    check_angle(s, t, point(common), angle(direction(s, common), direction(t, common)));
  }
  void check_angle(const Chord& s, const Chord& t, const Point& at, double between) const {
    if (between >= smallest_angle) return;
    const Field& field = line(t).field;
    refuse(field, field, " and ", line(s).field, " meet at ", shown(at), " at an angle of ",
           shown(between * 180 / std::numbers::pi),
           " degrees, nearly along each other; let them meet at more than one degree");
  }
  /// Checks the angle of two lines that pass through a point, whichever way they are walked.
  void check_passing(const Chord& s, const Chord& t, const Point& at, const Point& d,
                     const Point& e) const {
    const double between = angle(d, e);
    check_angle(s, t, at, std::min(between, std::numbers::pi - between));
  }

  /// Checks two sides, which may meet at their ends, or a hole and another line of the boundary.
  void between_boundaries(const Chord& s, const Chord& t, int common) const {
    const bool sides = at(t.line) < _network.outer;
    const bool follow = sides && common >= 0 && (s.b == t.a || t.b == s.a);
    const bool meets = follow ? other(s, common) == other(t, common) || on_one_another(s, t, common)
                              : common >= 0 || distance(segment(s), segment(t)) <= _tolerance;
    const Field& field = line(t).field;
    if (meets) {
      refuse(field, field, " and ", line(s).field, " touch or cross near ", shown(segment(t).a),
             sides ? "; sides of the boundary meet at their ends only"
                   : "; a hole lies inside the boundary and touches neither it nor another hole");
    }
    if (follow) check_angle(s, t, common);
  }

  /// Checks a line against the boundary, of which `s` is a chord.
  void against_boundary(const Chord& s, const Chord& t, int common) const {
    const NetworkLine& other_line = line(t);
    const Field& field = other_line.field;
    const bool at_its_end =
        common >= 0 && !other_line.line.closed() &&
        (common == other_line.stations.front().point || common == other_line.stations.back().point);
    const bool meets = at_its_end
                           ? other(s, common) == other(t, common) || on_one_another(s, t, common)
                           : common >= 0 || distance(segment(s), segment(t)) <= _tolerance;
    if (meets) {
      refuse(field, field,
             " leaves the membrane or touches its boundary in between: the stretch from ",
             shown(segment(t).a), " to ", shown(segment(t).b), " meets the edge ",
             shown(segment(s).a), "-", shown(segment(s).b), " of ", line(s).field,
             other_line.line.closed() ? "; it must lie inside, apart from the boundary"
                                      : "; only its two ends may lie on the boundary");
    }
    if (at_its_end) check_angle(s, t, common);
  }

  void cross(const Chord& s, const Chord& t) {
    Crossing crossing{{s.line, t.line}, {}, {}};
    const auto [u, v] = meeting_point(segment(s), segment(t));
    crossing.t = {s.from + u * (s.to - s.from), t.from + v * (t.to - t.from)};
    const Line& first = line(s).line;
    const Line& second = line(t).line;
    refine(s, t, crossing.t);
    crossing.at = first.straight() ? second.at(crossing.t[1]) : first.at(crossing.t[0]);
    _crossings.push_back(crossing);
    check_meetings(_crossings.size(), _most);
  }

  /// Solves c1(t1) = c2(t2) by Newton's method; the curves are nearly straight within their chords.
  /// Lines along each other, for which the system is singular to rounding, are refused first.
  void refine(const Chord& s, const Chord& other, std::array<double, 2>& t) const {
    const Line& first = line(s).line;
    const Line& second = line(other).line;
    for (int i = 0; i < 8; ++i) {
      const Point p = first.at(t[0]);
      const Point q = second.at(t[1]);
      const Point d = first.derivative(t[0]);
      const Point e = second.derivative(t[1]);
      check_passing(s, other, p, d, e);
      const double det = d[1] * e[0] - d[0] * e[1];
      const Point gap{q[0] - p[0], q[1] - p[1]};
      const double step0 = (gap[1] * e[0] - gap[0] * e[1]) / det;
      const double step1 = (d[0] * gap[1] - d[1] * gap[0]) / det;
      t[0] = first.on_line(t[0] + std::clamp(step0, -0.25, 0.25));
      t[1] = second.on_line(t[1] + std::clamp(step1, -0.25, 0.25));
      if (step0 == 0 && step1 == 0) return;
    }
  }

  const Network& _network;
  double _tolerance;
  std::size_t _most;
  std::vector<Crossing> _crossings;
};

}  // namespace

std::vector<Crossing> find_crossings(const Network& network, std::size_t most) {
  Meetings meetings(network, most);
  std::vector<Segment> segments;
  segments.reserve(network.chords.size());
  for (const Chord& chord : network.chords) segments.push_back(meetings.segment(chord));
  each_near_pair(segments, network.tolerance, [&](std::size_t s, std::size_t t) {
    meetings.meet(network.chords[s], network.chords[t]);
  });
  return meetings.take();
}

}  // namespace anticrack::mesh
