// SPDX-License-Identifier: GPL-3.0-or-later
//
// All lines of a geometry cut into straight chords that meet only at their ends.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_line.hpp"
#include "mesh/geometry_outline.hpp"

namespace anticrack::mesh {

/// A point of the network on a line.
struct Station {
  double t = 0;  ///< the line's parameter
  int point = 0;
};

struct NetworkLine {
  std::string field;  ///< "boundary", "interfaces[0].arc", "options.align[0]"
  Role role = Role::interface;
  Line line;
  std::vector<Station> stations;  ///< in order; a closed line's first is not there again
};

/// From points[a] to points[b] along a line, in its order.
struct Chord {
  int line = 0;
  int a = 0;
  int b = 0;
  double from = 0;  ///< parameters of the line; from < to, also where a closed line ends
  double to = 0;
};

/// Points by the cell of a grid they lie in, to find the one that is within a tolerance.
class PointIndex {
 public:
  /// The number of the point within `tolerance` of `p`, -1 for none.
  int find(const std::vector<Point>& points, const Point& p, double tolerance) const;
  void add(const Point& p, int number, double tolerance);

 private:
  std::unordered_multimap<std::uint64_t, int> _cells;
};

struct Network {
  std::vector<NetworkLine> lines;  ///< the boundary (counterclockwise), interfaces, align
  std::vector<Point> points;
  PointIndex stations;        ///< the points that are stations of a line
  double tolerance = 0;       ///< two points nearer to one another are one
  std::vector<Chord> chords;  ///< line by line, each in its order
};

/// The boundary, the interfaces and the lines to be followed, checked one by one, no chords yet.
/// Throws errors::Error (geometry_invalid, limit_exceeded).
Network lay_lines(const Geometry& geometry, const MeshOptions& options);

/// A point of the geometry: every line that passes it within its tolerance gets a station there,
/// which has these coordinates unless a point is there already. The number of the point.
int mark(Network& network, const Point& p);

/// The parameter of the line's station at a point of the network; -1 where it has none.
double station_of(const NetworkLine& line, int point) noexcept;

/// Cuts the lines at their stations and where they cross, curved ones into chords no longer than
/// `size` with ends on the curve. Throws errors::Error: geometry_invalid where lines run along each
/// other, leave the membrane or meet at too small an angle; limit_exceeded at "options.size" for
/// more than `max_chords`.
void cut(Network& network, double size, std::size_t max_chords);

}  // namespace anticrack::mesh
