// SPDX-License-Identifier: GPL-3.0-or-later
//
// All lines of a geometry, cut into straight chords that meet only at their ends.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_field.hpp"
#include "mesh/geometry_line.hpp"
#include "mesh/geometry_own_lines.hpp"

namespace anticrack::mesh {

/// A point of the network on a line.
struct Station {
  double t = 0;  ///< the line's parameter
  int point = 0;
};

struct NetworkLine {
  Field field;  ///< "boundary", "sides[2].line.arc", "interfaces[0].arc", "options.align[0]"
  Role role = Role::interface;
  Line line;
  std::vector<Station> stations;  ///< in order; the first of a closed line is not repeated
  std::vector<std::array<double, 2>> parts{};  ///< parameters of ends of inclusions and cracks

  /// Which of two stations, one behind the other, are tips of what lies between them.
  Tips tips(double from, double to) const noexcept;
};

/// A chord from points[a] to points[b] along a line, in its direction.
struct Chord {
  int line = 0;
  int a = 0;
  int b = 0;
  double from = 0;  ///< parameters of the line; from < to, also across the joint of a closed line
  double to = 0;
};

/// Finds a point within a tolerance, by the cells of a grid.
class PointIndex {
 public:
  /// The number of the point within `tolerance` of `p`, -1 for none.
  int find(const std::vector<Point>& points, const Point& p, double tolerance) const;
  void add(const Point& p, int number, double tolerance);

 private:
  std::unordered_multimap<std::uint64_t, int> _cells;
};

struct Network {
  /// The outer boundary (counterclockwise, one line or the sides in their order), holes
  /// (clockwise), interfaces, align.
  std::vector<NetworkLine> lines;
  bool turned = false;       ///< the outer boundary was written clockwise
  std::size_t outer = 0;     ///< number of lines of the outer boundary
  std::size_t boundary = 0;  ///< number of lines of the outer boundary and the holes
  std::vector<Point> points;
  PointIndex stations;        ///< the points that are stations of a line
  double tolerance = 0;       ///< points closer than this are one
  std::vector<Chord> chords;  ///< line by line, each in its order
};

/// The boundary, the interfaces and the align lines, each checked by itself; no chords yet.
/// Throws errors::Error: geometry_invalid; limit_exceeded, also if more than `max_meetings`
/// vertices of lines lie on other lines.
Network lay_lines(const Drawn& geometry, const MeshOptions& options, std::size_t max_meetings);

/// Adds a station at `p` to every line that passes within the tolerance. Uses an existing point
/// there, if any. Returns the number of the point.
int mark(Network& network, const Point& p);

/// The parameter of the line's station at a point of the network; -1 if it has none there.
double station_of(const NetworkLine& line, int point) noexcept;

/// Cuts the lines at their stations and crossings, and curved lines into chords of the rule with
/// ends on the curve. Throws errors::Error: geometry_invalid if lines run along each other, leave
/// the membrane or meet at too small an angle; limit_exceeded at "options.size" beyond
/// `max_chords`.
void cut(Network& network, const ChordRule& rule, std::size_t max_chords);

/// Moves ends of chords off their curve, to the side on which it bulges, so that chords between two
/// stations of a line leave as much area on one side of it as on the other. Ends stay where they
/// would come near another chord. O(c log c + pairs of chords over the same x).
void balance_areas(Network& network);

/// Two lines that meet at a place where at least one of them has no station.
struct Crossing {
  std::array<int, 2> line{};
  std::array<double, 2> t{};
  Point at{};
};

/// Throws errors::Error (limit_exceeded) at "interfaces" if lines meet in more than `most` points.
void check_meetings(std::size_t count, std::size_t most);

/// Checks every pair of chords and returns the crossings that have no stations yet. Throws
/// geometry_invalid for a line that meets itself, leaves the membrane, touches the boundary other
/// than with its ends, runs along another line or meets it at less than a degree, and for a hole
/// that touches another line of the boundary; limit_exceeded for more than `most` crossings. O(c
/// log c + pairs of chords over the same x).
std::vector<Crossing> find_crossings(const Network& network, std::size_t most);

}  // namespace anticrack::mesh
