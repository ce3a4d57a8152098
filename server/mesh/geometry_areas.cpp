// SPDX-License-Identifier: GPL-3.0-or-later
//
// Chords with their ends on a curve leave area on one side of it, and an energy off by as much.
// With ends a third of the way beyond, as much lies on the other side: what is left of the
// difference is of the third order in the angle of a chord, not of the second (THEORY.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/at.hpp"
#include "mesh/geometry_network.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

double cross(const Point& a, const Point& b) noexcept { return a[0] * b[1] - a[1] * b[0]; }

/// Chords [first, end) of the network that lie between two stations of one line.
struct ChordRange {
  std::size_t first = 0;
  std::size_t end = 0;
};

std::vector<ChordRange> between_stations(const Network& network) {
  std::vector<bool> station(network.points.size(), false);
  for (const NetworkLine& line : network.lines)
    for (const Station& each : line.stations) station[at(each.point)] = true;
  std::vector<ChordRange> ranges;
  for (std::size_t e = 0; e < network.chords.size(); ++e) {
    if (station[at(network.chords[e].a)]) ranges.push_back({e, e});
    ranges.back().end = e + 1;
  }
  return ranges;
}

/// The area between a chord and its curve, positive if the curve is on the right of the chord:
/// half the integral of (p - a) x dp by three points of Gauss, exact for a spline.
double area_beside(const Network& network, const Chord& chord) {
  constexpr std::array<std::pair<double, double>, 3> rule{
      {{-0.7745966692414834, 5. / 9}, {0, 8. / 9}, {0.7745966692414834, 5. / 9}}};
  const Line& line = network.lines[at(chord.line)].line;
  const double half = (chord.to - chord.from) / 2;
  double sum = 0;
  for (const auto& [x, weight] : rule) {
    const double t = line.on_line((chord.from + chord.to) / 2 + half * x);
    sum += weight * cross(minus(line.at(t), network.points[at(chord.a)]), line.derivative(t));
  }
  return half * sum / 2;
}

/// A unit vector to the right of a line.
Point right_of(const Line& line, double t) {
  const Point d = line.derivative(t);
  const double length = std::hypot(d[0], d[1]);
  return {d[1] / length, -d[0] / length};
}

struct Move {
  int point = 0;
  Point by{};
};

/// What the ends of chords within a range move by, so that the area beside all of them becomes 0;
/// each by the area beside its two chords.
std::vector<Move> moves_of(const Network& network, const ChordRange& range) {
  const auto& chords = network.chords;
  std::vector<Move> moves;
  std::vector<double> beside;
  double all = 0, gained = 0;
  for (std::size_t e = range.first; e < range.end; ++e) {
    beside.push_back(area_beside(network, chords[e]));
    all += beside.back();
  }
  for (std::size_t k = 1; k < beside.size(); ++k) {
    const Chord& next = chords[range.first + k];
    const double both = beside[k - 1] + beside[k];
    gained += both / 2;
    const double base =
        distance(network.points[at(chords[range.first + k - 1].a)], network.points[at(next.b)]);
    const Line& line = network.lines[at(next.line)].line;
    const Point right = right_of(line, line.on_line(next.from));
    moves.push_back({next.a, {both / base * right[0], both / base * right[1]}});
  }
  const double scale = gained == 0 ? 1 : std::clamp(all / gained, 0.5, 2.0);
  for (Move& move : moves)
    for (double& part : move.by) part *= scale;
  return moves;
}

/// The distance of two chords; that of their other ends if they share one.
double gap(const Network& network, const Chord& s, const Chord& t) {
  const auto segment = [&](const Chord& chord) {
    return Segment{network.points[at(chord.a)], network.points[at(chord.b)]};
  };
  const auto other = [](const Chord& chord, const Chord& than) {
    return chord.a == than.a || chord.a == than.b ? chord.b : chord.a;
  };
  if (s.a != t.a && s.a != t.b && s.b != t.a && s.b != t.b) return distance(segment(s), segment(t));
  return std::min(distance(network.points[at(other(s, t))], segment(t)),
                  distance(network.points[at(other(t, s))], segment(s)));
}

}  // namespace

void balance_areas(Network& network) {
  constexpr double room = 4;  // a chord this many times as far off as ends move is not in their way
  std::vector<Move> moves;
  std::vector<double> reach(network.points.size(), 0);
  for (const ChordRange& range : between_stations(network)) {
    const NetworkLine& on = network.lines[at(network.chords[range.first].line)];
    if (on.line.straight()) continue;
    for (const Move& move : moves_of(network, range)) {
      moves.push_back(move);
      reach[at(move.point)] = room * std::hypot(move.by[0], move.by[1]);
    }
  }
  if (moves.empty()) return;
  std::vector<Segment> segments;
  for (const Chord& chord : network.chords)
    segments.push_back({network.points[at(chord.a)], network.points[at(chord.b)]});
  std::vector<bool> stays(network.points.size(), false);
  each_near_pair(segments, *std::ranges::max_element(reach), [&](std::size_t i, std::size_t j) {
    const Chord& s = network.chords[i];
    const Chord& t = network.chords[j];
    const std::array ends{s.a, s.b, t.a, t.b};
    double most = 0;
    for (const int end : ends) most = std::max(most, reach[at(end)]);
    if (most == 0 || gap(network, s, t) > most) return;
    for (const int end : ends) stays[at(end)] = true;
  });
  for (const auto& [point, by] : moves) {
    if (stays[at(point)]) continue;
    Point& p = network.points[at(point)];
    p = {p[0] + by[0], p[1] + by[1]};
  }
}

}  // namespace anticrack::mesh
