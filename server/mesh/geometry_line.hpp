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

/// How curves are cut: a chord is at most `size` long, and the curve turns by at most `turn` on it.
struct ChordRule {
  double size = 0;
  double turn = std::numbers::pi / 36;  ///< radians
};

/// Span k of a line runs over the parameters [k, k+1]; the ends of the spans are its vertices.
class Line {
 public:
  /// Straight between its points, which follow each other at a distance.
  static Line polyline(std::vector<Point> points, bool closed);
  /// From a through b to c, all three vertices; they are not on one straight line.
  static Line arc(const Point& a, const Point& b, const Point& c);
  /// Clockwise from the point above the centre; four spans. The radius is positive.
  static Line circle(const Point& centre, double radius);
  /// At least 3 points, no two consecutive ones equal.
  static Line spline(std::vector<Point> points, bool closed);

  bool closed() const noexcept { return _closed; }
  /// Whether its spans are straight lines.
  bool straight() const noexcept { return _shape == Shape::polyline; }
  int spans() const noexcept { return _spans; }
  double length() const noexcept { return _length; }
  /// Points at the parameters 0, 1, ...; of a closed line the last is left out.
  const std::vector<Point>& vertices() const noexcept { return _vertices; }

  /// A parameter at most one turn off a closed line in [0, spans), one of an open line clipped.
  double on_line(double t) const noexcept;

  /// The point at a parameter, clipped to the line, and its derivative by the parameter.
  Point at(double t) const noexcept;
  Point derivative(double t) const noexcept;

  /// Where the line passes within `tolerance` of `p`; in [0, spans), of an open line also spans.
  /// O(log(spans)) where the line does not come near `p` many times.
  std::optional<double> locate(const Point& p, double tolerance) const;
  /// Of `p` from the line; exact for a polyline, else from fine chords.
  double distance_to(const Point& p) const noexcept;
  /// The parameter up to which the line from `from` on has a part of its length up to `to`.
  /// O(samples).
  double along(double from, double to, double part) const;
  /// How many chords of a rule the line takes from one parameter to another. Not for polylines.
  double chords_between(double from, double to, const ChordRule& rule) const;
  /// Parameters strictly between that cut this part of the line into such chords.
  std::vector<double> cuts_between(double from, double to, const ChordRule& rule) const;

 private:
  struct Sample {
    double t = 0;
    Point p{};
  };
  struct Box {
    Segment diagonal;
    double slack = 0;  ///< a curve leaves the chords of its samples by less
  };
  Line(Shape shape, bool closed, std::vector<Point> vertices);
  void sample();
  int samples_in_span() const noexcept;
  static Box around(const Box& a, const Box& b) noexcept;
  Box box_of(std::size_t first, std::size_t last) const noexcept;
  double bulge(int k) const noexcept;
  int span_of(double t) const noexcept;
  Point vertex(int k) const noexcept;
  double sweep(int k) const noexcept;
  double angle_at(int k, double u) const noexcept;
  double closest(const Point& p, const Sample& low, const Sample& high) const noexcept;
  std::vector<double> measure(double from, double to, const ChordRule& rule, int steps) const;

  Shape _shape = Shape::polyline;
  bool _closed = false;
  int _spans = 0;
  double _length = 0;
  std::vector<Point> _vertices;
  std::vector<Point> _out;  ///< spline: derivative at the beginning of each span
  std::vector<Point> _in;   ///< and at its end
  Point _centre{};
  double _radius = 0;
  std::vector<double> _angles;   ///< arc, circle: where each span begins and ends, from the centre
  std::vector<Sample> _samples;  ///< as many in every span
  std::vector<Box> _boxes;       ///< a tree: node i is around 2i and 2i + 1, span k is spans + k
};

}  // namespace anticrack::mesh
