// SPDX-License-Identifier: GPL-3.0-or-later
//
// A line of the plane with a parameter: polyline, arc through three points, circle, or centripetal
// Catmull-Rom spline (E. Catmull, R. Rom 1974; P. Yuksel, S. Schaefer, J. Keyser, Parameterization
// and applications of Catmull-Rom curves, Computer-Aided Design 43 (2011)). Lengths in the unit of
// the geometry.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {

/// Rule to cut curves: a chord is at most `size` long, and the curve turns by at most `turn` along
/// it.
struct ChordRule {
  double size = 0;
  double turn = default_chord_angle * std::numbers::pi / 180;  ///< radians
};

/// Which ends of a part of a line are tips, where slopes of u are infinite. A chord there is 0.03
/// as long as the rule lets it be, and those behind it grow by a fifth of their distance from the
/// tip.
struct Tips {
  bool at_from = false, at_to = false;
  /// How many chords take the place of `chords` of the rule.
  double count(double chords) const noexcept;
  /// Up to which of `chords` of the rule the first `k` of these go.
  double reach(double k, double chords) const noexcept;
};

/// Span k of a line runs over the parameters [k, k+1]; the ends of the spans are its vertices.
class Line {
 public:
  /// Straight between its points; consecutive points must differ.
  static Line polyline(std::vector<Point> points, bool closed);
  /// From a through b to c, which are its vertices and must not be on one straight line.
  static Line arc(const Point& a, const Point& b, const Point& c);
  /// Clockwise from the point above the centre, in four spans. The radius must be positive.
  static Line circle(const Point& centre, double radius);
  /// Through at least 3 points; consecutive points must differ.
  static Line spline(std::vector<Point> points, bool closed);

  bool closed() const noexcept { return _closed; }
  /// Whether its spans are straight lines.
  bool straight() const noexcept { return _shape == Shape::polyline; }
  int spans() const noexcept { return _spans; }
  double length() const noexcept { return _length; }
  /// Points at the parameters 0, 1, ...; without the last one if the line is closed.
  const std::vector<Point>& vertices() const noexcept { return _vertices; }

  /// Brings a parameter onto the line: for a closed line, one that is at most one turn off into [0,
  /// spans); for an open line it is clipped.
  double on_line(double t) const noexcept;

  /// The point at a parameter, which is clipped to the line, and the derivative by the parameter.
  Point at(double t) const noexcept;
  Point derivative(double t) const noexcept;
  /// Span k of a line that is not straight.
  Bend bend(int k) const noexcept;

  /// The parameter at which the line passes within `tolerance` of `p`, in [0, spans), or up to
  /// spans if the line is open. O(log(spans)) if the line does not come near `p` many times.
  std::optional<double> locate(const Point& p, double tolerance) const {
    return near(_box, p, tolerance) ? search(p, tolerance) : std::nullopt;  // most are far
  }
  /// Distance of `p` from the line; exact for a polyline, else that from fine chords.
  double distance_to(const Point& p) const noexcept;
  /// The parameter up to which the line from `from` on has the fraction `part` of its length up to
  /// `to`. O(samples).
  double along(double from, double to, double part) const;
  /// How many chords the line needs by a rule between two parameters. Not for polylines.
  double chords_between(double from, double to, const ChordRule& rule) const;
  /// The parameters, strictly between the two, that cut this part of the line into such chords,
  /// towards tips into shorter ones.
  std::vector<double> cuts_between(double from, double to, const ChordRule& rule,
                                   Tips tips = {}) const;

 private:
  struct Sample {
    double t = 0;
    Point p{};
  };
  struct Box {
    Segment diagonal;
    double slack = 0;  ///< a curve is nearer than this to the chords of its samples
  };
  static bool near(const Box& box, const Point& p, double tolerance) noexcept {
    return boxes_meet(box.diagonal, {p, p}, tolerance + box.slack);
  }
  std::optional<double> search(const Point& p, double tolerance) const;
  Line(Shape shape, bool closed, std::vector<Point> vertices);
  void sample();
  int samples_in_span() const noexcept;
  static Box around(const Box& a, const Box& b) noexcept;
  Box box_of(std::size_t first, std::size_t last) const noexcept;
  double bulge(int k) const noexcept;
  int span_of(double t) const noexcept;
  Point vertex(int k) const noexcept;
  double sweep(int k) const noexcept;
  double closest(const Point& p, const Sample& low, const Sample& high) const noexcept;
  std::vector<double> measure(double from, double to, const ChordRule& rule, int steps) const;

  Box _box{};  ///< of the whole line; here, not with the others, as many lines are looked at
  Shape _shape = Shape::polyline;
  bool _closed = false;
  int _spans = 0;
  double _length = 0;
  std::vector<Point> _vertices;
  std::vector<Point> _out;  ///< spline: derivative at the beginning of each span
  std::vector<Point> _in;   ///< spline: derivative at the end of each span
  Point _centre{};
  double _radius = 0;
  std::vector<double> _angles;   ///< arc, circle: angles at the centre where spans begin and end
  std::vector<Sample> _samples;  ///< equally many in every span
  std::vector<Box> _boxes;       ///< tree: node i has 2i and 2i + 1, span k is spans + k
};

}  // namespace anticrack::mesh
