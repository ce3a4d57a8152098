// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_network.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/at.hpp"
#include "mesh/geometry_boundary.hpp"
#include "mesh/geometry_curves.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

void check_counts(const Drawn& geometry, const MeshOptions& options) {
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

/// Adds a station at a point to all lines through it except `but`. Returns how many it added.
std::size_t mark_others(Network& network, const Point& p, int point, std::size_t but) {
  std::size_t through = 0;
  for (std::size_t l = 0; l < network.lines.size(); ++l) {
    if (l == but) continue;
    const auto t = network.lines[l].line.locate(p, network.tolerance);
    if (!t) continue;
    add_station(network.lines[l], *t, point);
    ++through;
  }
  return through;
}

/// The key of the cell of a point, shifted by dx, dy cells. Cells are four tolerances wide.
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
                 const ChordRule& rule, std::size_t max_chords) {
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
    if (line.chords_between(from.t, to.t, rule) + static_cast<double>(network.chords.size()) >
        static_cast<double>(max_chords)) {
      throw errors::Error(errors::Reason::limit_exceeded,
                          "an edge length of {} and chords of {} degrees cut the lines into more "
                          "than {} pieces; choose larger ones",
                          shown(rule.size), shown(rule.turn * 180 / std::numbers::pi), max_chords)
          .at("options.size");
    }
    const Tips tips = network.lines[l].tips(from.t, to.t);
    for (const double t : line.cuts_between(from.t, to.t, rule, tips)) {
      network.points.push_back(line.at(t));
      add(t, static_cast<int>(network.points.size()) - 1);
    }
  }
  add(to.t, to.point);
}

void cut_line(Network& network, std::size_t l, const ChordRule& rule, std::size_t max_chords) {
  const std::vector<Station> stations = network.lines[l].stations;
  const Line& line = network.lines[l].line;
  for (std::size_t i = 1; i < stations.size(); ++i)
    cut_stretch(network, l, stations[i - 1], stations[i], rule, max_chords);
  if (line.closed()) {
    Station again = stations.front();
    again.t += line.spans();
    cut_stretch(network, l, stations.back(), again, rule, max_chords);
  }
}

/// Refuses lines that run outside the membrane. One chord of each line is tested: a ray from a
/// point in the membrane meets the boundary in an odd number of points.
void check_inside(const Network& network) {
  std::vector<std::vector<Segment>> edges(network.boundary);
  for (const Chord& chord : network.chords)
    if (at(chord.line) < network.boundary)
      edges[at(chord.line)].push_back({network.points[at(chord.a)], network.points[at(chord.b)]});
  int before = -1;
  for (const Chord& chord : network.chords) {
    if (chord.line == before || at(chord.line) < network.outer) continue;
    before = chord.line;
    const Point& a = network.points[at(chord.a)];
    const Point& b = network.points[at(chord.b)];
    const Point middle{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    const auto around = [&](std::size_t l) {
      return l != at(chord.line) && ray_meets(middle, edges[l]);
    };
    bool odd = false;
    for (std::size_t l = 0; l < edges.size(); ++l)
      if (around(l)) odd = !odd;
    if (odd) continue;
    const Field& field = network.lines[at(chord.line)].field;
    std::size_t hole = network.outer;
    while (hole < network.boundary && !around(hole)) ++hole;
    refuse(
        field, field, " lies ",
        hole < network.boundary ? "in " + network.lines[hole].field.shown : "outside the boundary",
        ", at ", shown(middle), "; it must lie in the membrane");
  }
}

}  // namespace

Tips NetworkLine::tips(double from, double to) const noexcept {
  constexpr double same = 1e-9;
  Tips found;
  for (const auto& [begin, end] : parts) {
    for (const double turn : {0.0, static_cast<double>(line.spans())}) {
      if (turn > 0 && !line.closed()) break;
      if (from < begin - turn - same || to > end - turn + same) continue;
      found.at_from |= std::abs(from - (begin - turn)) < same;
      found.at_to |= std::abs(to - (end - turn)) < same;
    }
  }
  return found;
}

void check_meetings(std::size_t count, std::size_t most) {
  if (count <= most) return;
  throw errors::Error(
      errors::Reason::limit_exceeded,
      "the lines meet in more than {} points, which is the limit; leave some of the lines out",
      most)
      .at("interfaces");
}

Network lay_lines(const Drawn& geometry, const MeshOptions& options, std::size_t max_meetings) {
  Boundary boundary = lay_boundary(geometry);
  check_counts(geometry, options);
  Network network;
  network.tolerance = boundary.outline.tolerance;
  network.turned = boundary.turned;
  network.outer = boundary.outer;
  network.boundary = boundary.lines.size();
  network.lines = std::move(boundary.lines);
  network.lines.reserve(network.boundary + geometry.interfaces.size() + options.align.size());
  for (std::size_t i = 0; i < geometry.interfaces.size(); ++i) {
    const Field& field = geometry.fields[i];
    network.lines.push_back(
        {field, Role::interface, lay_curve(geometry.interfaces[i], field, boundary.outline), {}});
  }
  for (std::size_t i = 0; i < options.align.size(); ++i) {
    const Field field = indexed("options.align", i);
    network.lines.push_back(
        {field,
         Role::align,
         lay_curve({"", Shape::polyline, options.align[i]}, field, boundary.outline),
         {}});
  }
  std::size_t stations = 0;  // stations that are vertices of another line
  for (std::size_t l = 0; l < network.lines.size(); ++l) {
    const std::vector<Point> vertices = network.lines[l].line.vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const std::size_t before = network.points.size();
      const int point = point_at(network, vertices[v]);
      add_station(network.lines[l], static_cast<double>(v), point);
      // A point that was known before has its stations already.
      if (network.points.size() > before) stations += mark_others(network, vertices[v], point, l);
    }
    check_meetings(stations, max_meetings);
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
        // the one with the lowest number, whatever the order of the table
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

void cut(Network& network, const ChordRule& rule, std::size_t max_chords) {
  constexpr int rounds = 5;
  std::size_t known = network.points.size();  // points that are stations
  for (int round = 0; round < rounds; ++round) {
    network.chords.clear();
    network.points.resize(known);
    for (std::size_t l = 0; l < network.lines.size(); ++l) cut_line(network, l, rule, max_chords);
    const std::vector<Crossing> found = find_crossings(network, max_chords);
    if (found.empty()) {
      check_inside(network);
      return;
    }
    network.points.resize(known);  // chords are cut anew: keep only stations
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
