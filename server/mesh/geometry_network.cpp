// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mesh/at.hpp"
#include "mesh/geometry_crossings.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

/// Refuses points far outside the membrane first: products of such coordinates would overflow.
void check_near(const Point& p, const std::string& field, const Outline& outline) {
  if (distance(p, outline.boundary.front()) > 10 * outline.tolerance / relative_tolerance)
    refuse(field, field, " ", show(p), " lies outside the polygon; it must lie in the membrane");
}

/// Of a polyline or spline.
void check_vertices(const std::vector<Point>& points, const std::string& owner,
                    const std::string& field, const Outline& outline) {
  check_points(points, field);
  for (std::size_t i = 0; i < points.size(); ++i) check_near(points[i], indexed(field, i), outline);
  check_distinct(points, field, outline.tolerance);
  if (distance(points.front(), points.back()) <= outline.tolerance) {
    refuse(owner, owner, " starts and ends at the same point ", show(points.front()),
           "; for a closed line set `closed` and leave the last point out");
  }
}

Line polyline_of(const std::vector<Point>& points, bool closed, const std::string& owner,
                 const std::string& field, const Outline& outline) {
  const std::size_t least = closed ? 3 : 2;
  if (points.size() < least) {
    refuse(owner, owner, " has ", points.size(), " vertices; a ", (closed ? "closed " : ""),
           "polyline takes at least ", least);
  }
  check_vertices(points, owner, field, outline);
  check_simple(points, closed, owner, field, outline.tolerance);
  return Line::polyline(points, closed);
}

Line spline_of(const InterfaceSpec& spec, const std::string& owner, const Outline& outline) {
  if (spec.points.size() < 3)
    refuse(owner, owner, " has ", spec.points.size(), " points; a spline takes at least 3");
  check_vertices(spec.points, owner, owner + ".points", outline);
  return Line::spline(spec.points, spec.closed);
}

Line arc_of(const InterfaceSpec& spec, const std::string& owner, const Outline& outline) {
  const double tolerance = outline.tolerance;
  if (spec.points.size() != 3) {
    refuse(owner, owner, " has ", spec.points.size(),
           " points; an arc is given by three: from, through, to");
  }
  if (spec.closed)
    refuse(owner, owner, " is closed, which an arc cannot be; make the circle a closed spline");
  const std::array<const char*, 3> names{".from", ".through", ".to"};
  for (std::size_t i = 0; i < 3; ++i) {
    check_point(spec.points[i], owner + names[i]);
    check_near(spec.points[i], owner + names[i], outline);
  }
  const Point& a = spec.points[0];
  const Point& b = spec.points[1];
  const Point& c = spec.points[2];
  if (distance(a, c) <= tolerance)
    refuse(owner + ".to", owner, " starts and ends at the same point ", show(a));
  const double ab = distance(a, b), bc = distance(b, c), ac = distance(a, c);
  const double twice_area = std::abs(signed_area(std::array{a, b, c})) * 2;
  // A flatter arc's centre is lost to rounding: its radius ab bc ac / (2 twice_area) exceeds the
  // membrane by far. The negation also catches NaN.
  const bool flat = distance(b, Segment{a, c}) <= 1e3 * tolerance ||
                    !(ab * bc * ac <= 1e15 * tolerance * twice_area);
  if (flat || ab <= tolerance || bc <= tolerance) {
    refuse(owner + ".through", owner, ".through ", show(b), " lies ", show(twice_area / ac),
           " off the straight line through ", show(a), " and ", show(c),
           "; that is not an arc, give a polyline instead");
  }
  return Line::arc(a, b, c);
}

NetworkLine interface_line(const InterfaceSpec& spec, const std::string& name,
                           const Outline& outline) {
  switch (spec.shape) {
    case Shape::arc:
      return {name + ".arc", Role::interface, arc_of(spec, name + ".arc", outline), {}};
    case Shape::spline:
      return {name + ".spline", Role::interface, spline_of(spec, name + ".spline", outline), {}};
    case Shape::polyline:
      break;
  }
  const std::string field = name + ".polyline";
  return {field,
          Role::interface,
          polyline_of(spec.points, spec.closed, field, field + ".points", outline),
          {}};
}

void check_counts(const Geometry& geometry, const MeshOptions& options) {
  check_count(geometry.interfaces.size(), "interfaces", "entries", max_interfaces);
  check_count(options.align.size(), "options.align", "lines", max_interfaces);
  std::size_t vertices = 0;
  for (const InterfaceSpec& spec : geometry.interfaces) vertices += spec.points.size();
  check_count(vertices, "interfaces", "vertices");
  vertices = 0;
  for (const auto& line : options.align) vertices += line.size();
  check_count(vertices, "options.align", "vertices");
}

void add_station(NetworkLine& line, double t, int point) {
  for (const Station& station : line.stations)
    if (station.point == point) return;
  const auto after =
      std::upper_bound(line.stations.begin(), line.stations.end(), t,
                       [](double value, const Station& station) { return value < station.t; });
  line.stations.insert(after, {t, point});
}

int point_at(Network& network, const Point& p) {
  const int known = network.stations.find(network.points, p, network.tolerance);
  if (known >= 0) return known;
  network.points.push_back(p);
  const auto point = static_cast<int>(network.points.size()) - 1;
  network.stations.add(p, point, network.tolerance);
  return point;
}

/// Adds a station at a point to all lines through it except one.
void mark_others(Network& network, const Point& p, int point, std::size_t but) {
  for (std::size_t l = 0; l < network.lines.size(); ++l) {
    if (l == but) continue;
    const auto t = network.lines[l].line.locate(p, network.tolerance);
    if (t) add_station(network.lines[l], *t, point);
  }
}

/// Cells are four tolerances wide.
std::uint64_t cell(const Point& p, double tolerance, int dx, int dy) {
  const auto part = [&](double value, int shift) {
    // far outside the membrane all share one cell
    const double index = std::clamp(std::floor(value / (4 * tolerance)), -1e18, 1e18) + shift;
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(index));
  };
  return part(p[0], dx) * 0x9E3779B97F4A7C15U ^ part(p[1], dy);
}

/// Adds the chords between two stations of a line, with new points on curved lines.
void cut_stretch(Network& network, std::size_t l, const Station& from, const Station& to,
                 double size, std::size_t max_chords) {
  const Line& line = network.lines[l].line;
  Chord chord{static_cast<int>(l), from.point, 0, from.t, 0};
  const auto add = [&](double t, int point) {
    chord.to = t;
    chord.b = point;
    network.chords.push_back(chord);
    chord.from = t;
    chord.a = point;
  };
  if (!line.straight()) {
    if (line.chords_between(from.t, to.t, size) + static_cast<double>(network.chords.size()) >
        static_cast<double>(max_chords)) {
      throw errors::Error(errors::Reason::limit_exceeded,
                          "an edge length of " + show(size) + " cuts the lines into more than " +
                              std::to_string(max_chords) + " pieces; choose a larger one")
          .at("options.size");
    }
    for (const double t : line.cuts_between(from.t, to.t, size)) {
      network.points.push_back(line.at(t));
      add(t, static_cast<int>(network.points.size()) - 1);
    }
  }
  add(to.t, to.point);
}

void cut_line(Network& network, std::size_t l, double size, std::size_t max_chords) {
  const std::vector<Station> stations = network.lines[l].stations;
  const Line& line = network.lines[l].line;
  for (std::size_t i = 1; i < stations.size(); ++i)
    cut_stretch(network, l, stations[i - 1], stations[i], size, max_chords);
  if (line.closed()) {
    Station again = stations.front();
    again.t += line.spans();
    cut_stretch(network, l, stations.back(), again, size, max_chords);
  }
}

void check_inside(const Network& network, const std::vector<Point>& polygon) {
  int before = -1;
  for (const Chord& chord : network.chords) {
    if (chord.line == before || chord.line == 0) continue;
    before = chord.line;
    const Point& a = network.points[at(chord.a)];
    const Point& b = network.points[at(chord.b)];
    const Point middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    if (inside(middle, polygon)) continue;
    const std::string& field = network.lines[at(chord.line)].field;
    refuse(field, field, " runs outside the polygon, at ", show(middle),
           "; it must lie in the membrane");
  }
}

}  // namespace

Network lay_lines(const Geometry& geometry, const MeshOptions& options) {
  const Outline outline = check_outline(geometry.boundary);
  check_counts(geometry, options);
  Network network;
  network.tolerance = outline.tolerance;
  network.lines.reserve(1 + geometry.interfaces.size() + options.align.size());
  network.lines.push_back(
      {"boundary", Role::dirichlet, Line::polyline(outline.boundary, true), {}});
  for (std::size_t i = 0; i < geometry.interfaces.size(); ++i) {
    network.lines.push_back(
        interface_line(geometry.interfaces[i], indexed("interfaces", i), outline));
  }
  for (std::size_t i = 0; i < options.align.size(); ++i) {
    const std::string field = indexed("options.align", i);
    network.lines.push_back(
        {field,
         Role::align,
         polyline_of(options.align[i], false, field, field + ".points", outline),
         {}});
  }
  for (std::size_t l = 0; l < network.lines.size(); ++l) {
    const std::vector<Point> vertices = network.lines[l].line.vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const int point = point_at(network, vertices[v]);
      add_station(network.lines[l], static_cast<double>(v), point);
      mark_others(network, vertices[v], point, l);
    }
  }
  return network;
}

int PointIndex::find(const std::vector<Point>& points, const Point& p, double tolerance) const {
  int best = -1;
  for (const int dx : {-1, 0, 1}) {
    for (const int dy : {-1, 0, 1}) {
      const auto [first, last] = _cells.equal_range(cell(p, tolerance, dx, dy));
      for (auto entry = first; entry != last; ++entry) {
        const int number = entry->second;
        if (distance(points[at(number)], p) > tolerance) continue;
        // the first of several, whatever the order of the table
        if (best < 0 || number < best) best = number;
      }
    }
  }
  return best;
}

void PointIndex::add(const Point& p, int number, double tolerance) {
  _cells.emplace(cell(p, tolerance, 0, 0), number);
}

int mark(Network& network, const Point& p) {
  const int point = point_at(network, p);
  mark_others(network, p, point, network.lines.size());
  return point;
}

double station_of(const NetworkLine& line, int point) noexcept {
  for (const Station& station : line.stations)
    if (station.point == point) return station.t;
  return -1;
}

void cut(Network& network, double size, std::size_t max_chords) {
  constexpr int rounds = 5;
  std::size_t known = network.points.size();  // points that are stations
  for (int round = 0; round < rounds; ++round) {
    network.chords.clear();
    network.points.resize(known);
    for (std::size_t l = 0; l < network.lines.size(); ++l) cut_line(network, l, size, max_chords);
    const std::vector<Crossing> found = find_crossings(network);
    if (found.empty()) {
      check_inside(network, network.lines.front().line.vertices());
      return;
    }
    if (found.size() > max_chords) {
      throw errors::Error(errors::Reason::limit_exceeded,
                          "the lines cross in " + std::to_string(found.size()) +
                              " points; at most " + std::to_string(max_chords) + " are allowed")
          .at("interfaces");
    }
    network.points.resize(known);  // a crossing is not an end of a chord that is cut anew
    for (const Crossing& crossing : found) {
      const int point = point_at(network, crossing.at);
      add_station(network.lines[at(crossing.line[0])], crossing.t[0], point);
      add_station(network.lines[at(crossing.line[1])], crossing.t[1], point);
    }
    known = network.points.size();
  }
  refuse("interfaces",
         "the lines cross repeatedly in so small a region that the crossings cannot be told apart; "
         "let "
         "them meet at a larger angle");
}

}  // namespace anticrack::mesh
