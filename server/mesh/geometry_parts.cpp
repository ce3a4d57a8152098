// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_steps.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/at.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

constexpr const char* own_line =
    "; or give it a line of its own in place of from and to: points, arc, spline, or center, angle "
    "and length";

struct Ends {
  int from = 0;  ///< points of the network
  int to = 0;
};

/// The lines of a role that have a station at a point.
std::vector<int> lines_at(const Network& network, Role role, int point) {
  std::vector<int> lines;
  for (std::size_t l = 0; l < network.lines.size(); ++l) {
    const NetworkLine& line = network.lines[l];
    if (line.role == role && station_of(line, point) >= 0) lines.push_back(static_cast<int>(l));
  }
  return lines;
}

[[noreturn]] void refuse_off(const Network& network, const Point& p, const Field& field,
                             const char* cure = "") {
  double off = std::numeric_limits<double>::infinity();
  const Line* nearest = nullptr;
  for (const NetworkLine& line : network.lines) {
    if (line.role != Role::interface) continue;
    const double d = line.line.distance_to(p);
    if (d < off) nearest = &line.line;
    off = std::min(off, d);
  }
  if (nearest == nullptr)
    refuse(field, field, " ", shown(p), " lies on no interface: there is none", cure);
  const std::optional<double> t = nearest->locate(p, 1.01 * off);
  refuse(field, field, " ", shown(p), " lies ", shown(off),
         " off the interface; it must lie on it, to ", shown(snap_distance(network)),
         t ? "; nearest is " + shown(nearest->at(*t)) : "", cure);
}

Ends mark_ends(Network& network, const Part& part) {
  return {mark(network, part.from), mark(network, part.to)};
}

/// The interface on which both ends of a part lie.
int line_of(const Network& network, const Part& part, const Ends& ends, const Field& field) {
  const std::vector<int> from = lines_at(network, Role::interface, ends.from);
  const std::vector<int> to = lines_at(network, Role::interface, ends.to);
  if (from.empty()) refuse_off(network, part.from, field + ".from", own_line);
  if (to.empty()) refuse_off(network, part.to, field + ".to", own_line);
  if (ends.from == ends.to)
    refuse(field, field, " has no length: it runs from ", shown(part.from), " to ", shown(part.to));
  std::vector<int> both;
  std::set_intersection(from.begin(), from.end(), to.begin(), to.end(), std::back_inserter(both));
  const auto name = [&](int line) { return network.lines[at(line)].field; };
  if (both.empty()) {
    refuse(field, field, " starts on ", name(from[0]), " and ends on ", name(to[0]),
           "; it must lie on one interface");
  }
  if (both.size() > 1) {
    refuse(field, field, " may lie on ", name(both[0]), " or on ", name(both[1]),
           ", which both hold its two ends; make it two parts that are told apart");
  }
  return both[0];
}

/// A part between its stations on a line, in the line's order.
PlacedPart place(const Network& network, int l, const Ends& ends) {
  const NetworkLine& line = network.lines[at(l)];
  PlacedPart placed;
  placed.line = l;
  placed.begin = {station_of(line, ends.from), ends.from};
  placed.end = {station_of(line, ends.to), ends.to};
  if (placed.begin.t > placed.end.t) {
    if (line.line.closed()) {
      placed.end.t += line.line.spans();
    } else {
      std::swap(placed.begin, placed.end);
      placed.reversed = true;
    }
  }
  return placed;
}

/// A part that is all of an inclusion's or crack's own line.
PlacedPart place_own(const Network& network, std::size_t l) {
  const std::vector<Station>& stations = network.lines[l].stations;
  PlacedPart placed{static_cast<int>(l), stations.front(), stations.back()};
  placed.own = true;
  return placed;
}

/// The place of an inclusion that has the fraction `part` of its length before it.
Station place_at(Network& network, const PlacedPart& whole, double part) {
  if (part == (whole.reversed ? 1 : 0)) return whole.begin;
  if (part == (whole.reversed ? 0 : 1)) return whole.end;
  const Line& line = network.lines[at(whole.line)].line;
  const double t = line.along(whole.begin.t, whole.end.t, whole.reversed ? 1 - part : part);
  const int point = mark(network, line.at(t < line.spans() ? t : line.on_line(t)));
  const double own = station_of(network.lines[at(whole.line)], point);
  return {own < whole.begin.t ? own + line.spans() : own, point};
}

/// Places the stretches of an inclusion, which are given by fractions of its length.
std::vector<PlacedPart> place_stretches(Network& network, const InclusionSpec& inclusion,
                                        const PlacedPart& whole) {
  const Field list = whole.field.at(".delaminated_parts.stretches", "delaminated");
  check_count(inclusion.stretches.size(), list);
  std::vector<PlacedPart> parts;
  parts.reserve(inclusion.stretches.size());
  for (std::size_t k = 0; k < inclusion.stretches.size(); ++k) {
    const Field field = list[k];
    const auto [from, to] = inclusion.stretches[k];
    if (!(from >= 0 && from < to && to <= 1)) {
      refuse(field, field, " runs from ", shown(from), " to ", shown(to),
             "; it is given by arc length over the inclusion's, 0 <= from < to <= 1");
    }
    PlacedPart placed{whole.line, place_at(network, whole, from), place_at(network, whole, to),
                      field};
    if (placed.begin.point == placed.end.point)
      refuse(field, field, " from ", shown(from), " to ", shown(to), " is too short");
    if (placed.begin.t > placed.end.t) std::swap(placed.begin, placed.end);
    parts.push_back(std::move(placed));
  }
  return parts;
}

/// Places the delaminated parts of an inclusion, in order.
std::vector<PlacedPart> place_delaminated(Network& network, const InclusionSpec& inclusion,
                                          const PlacedPart& whole) {
  const Field list = whole.field.at(".delaminated_parts", "delaminated");
  check_count(inclusion.delaminated.size(), list);
  std::vector<PlacedPart> parts = place_stretches(network, inclusion, whole);
  const Point begin = network.points[at(whole.begin.point)];
  const Point end = network.points[at(whole.end.point)];
  for (std::size_t k = 0; k < inclusion.delaminated.size(); ++k) {
    const Field field = list[k];
    const Part& part = inclusion.delaminated[k];
    const Ends ends = mark_ends(network, part);
    const NetworkLine& line = network.lines[at(whole.line)];
    const auto within = [&](int point, const Point& p, const char* which) {
      double t = station_of(line, point);
      if (t < 0) refuse_off(network, p, field + which);
      if (t < whole.begin.t) t += line.line.closed() ? line.line.spans() : 0;
      if (t < whole.begin.t || t > whole.end.t)
        refuse(field + which, field + which, " ", shown(p),
               " lies outside its inclusion, which runs from ", shown(begin), " to ", shown(end));
      return Station{t, point};
    };
    PlacedPart placed;
    placed.begin = within(ends.from, part.from, ".from");
    placed.end = within(ends.to, part.to, ".to");
    if (ends.from == ends.to)
      refuse(field, field, " has no length: it runs from ", shown(part.from), " to ",
             shown(part.to));
    if (placed.begin.t > placed.end.t) std::swap(placed.begin, placed.end);
    placed.line = whole.line;
    placed.field = field;
    parts.push_back(std::move(placed));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const PlacedPart& a, const PlacedPart& b) { return a.begin.t < b.begin.t; });
  for (std::size_t k = 1; k < parts.size(); ++k) {
    if (parts[k].begin.t > parts[k - 1].end.t) continue;
    refuse(parts[k].field, parts[k].field, " and ", parts[k - 1].field, " overlap or touch at ",
           shown(network.points[at(parts[k].begin.point)]), "; make them one part");
  }
  return parts;
}

/// Adds the bonded and the delaminated stretches of one inclusion.
void add_inclusion(const PlacedPart& whole, LineSide side,
                   const std::vector<PlacedPart>& delaminated, Layout& layout) {
  const LineSide plus = whole.reversed ? LineSide::right : LineSide::left;
  double at = whole.begin.t;
  const auto add = [&](double end, Kind kind) {
    if (end > at)
      layout.stretches.push_back({whole.line, at, end, kind, whole.inclusion, side == plus});
    at = end;
  };
  for (const PlacedPart& part : delaminated) {
    add(part.begin.t, Kind::inclusion);
    add(part.end.t, Kind::delaminated);
  }
  add(whole.end.t, Kind::inclusion);
}

void check_pair(const Network& network, const PlacedPart& left, const PlacedPart& right,
                double shift) {
  const double begin = right.begin.t + shift;
  if (begin > left.end.t) return;
  const Field field = place_of(right);
  const std::string place = shown(network.points[at(right.begin.point)]);
  if (begin == left.end.t) {
    refuse(field, right.field, " and ", left.field, " share the tip ", place,
           "; make them one, which may come off in parts, or leave a gap between them");
  }
  refuse(field, right.field, " and ", left.field, " overlap from ", place,
         " on; a piece of the interface belongs to one inclusion or crack");
}

void check_apart(const Network& network, std::vector<PlacedPart> parts) {
  std::stable_sort(parts.begin(), parts.end(), [](const PlacedPart& a, const PlacedPart& b) {
    return std::pair(a.line, a.begin.t) < std::pair(b.line, b.begin.t);
  });
  for (std::size_t first = 0; first < parts.size();) {
    std::size_t last = first;
    while (last + 1 < parts.size() && parts[last + 1].line == parts[first].line) {
      check_pair(network, parts[last], parts[last + 1], 0);
      ++last;
    }
    const Line& line = network.lines[at(parts[first].line)].line;
    if (line.closed()) {
      if (last > first) check_pair(network, parts[last], parts[first], line.spans());
    }
    first = last + 1;
  }
}

}  // namespace

Field place_of(const PlacedPart& part) { return part.field.at(part.own ? ".line" : ".part", ""); }

Layout lay_parts(const Drawn& geometry, Network& network) {
  Layout layout;
  layout.parts.reserve(geometry.inclusions.size() + geometry.cracks.size());
  const auto add = [&](const Part& part, int own, const Field& owner, int inclusion) {
    const Field field = owner.at(".part", "");
    PlacedPart placed;
    if (own >= 0) {
      placed = place_own(network, network.boundary + at(own));
    } else {
      const Ends ends = mark_ends(network, part);
      placed = place(network, line_of(network, part, ends, field), ends);
    }
    placed.field = owner;
    placed.inclusion = inclusion;
    layout.parts.push_back(std::move(placed));
  };
  for (std::size_t i = 0; i < geometry.inclusions.size(); ++i) {
    const InclusionSpec& inclusion = geometry.inclusions[i];
    add(inclusion.part, geometry.inclusion_lines[i], {"inclusion", i, inclusion.name},
        static_cast<int>(i));
    const PlacedPart& whole = layout.parts.back();
    add_inclusion(whole, inclusion.delaminated_side, place_delaminated(network, inclusion, whole),
                  layout);
    const std::string fault = fault_of(inclusion.motion);
    if (!fault.empty()) refuse(whole.field + ".fixed", whole.field, ": ", fault);
  }
  for (std::size_t i = 0; i < geometry.cracks.size(); ++i) {
    const CrackSpec& crack = geometry.cracks[i];
    add(crack.part, geometry.crack_lines[i], {"crack", i, crack.name}, -1);
    const PlacedPart& placed = layout.parts.back();
    const Kind kind = crack.contact ? Kind::crack : Kind::free;
    layout.stretches.push_back({placed.line, placed.begin.t, placed.end.t, kind, -1});
  }
  check_apart(network, layout.parts);
  layout.neumann = lay_neumann(geometry, network);
  return layout;
}

const Stretch* stretch_of(const std::vector<Stretch>& stretches, const Network& network,
                          const Chord& chord) noexcept {
  const double spans = network.lines[at(chord.line)].line.spans();
  const double middle = (chord.from + chord.to) / 2;
  for (const Stretch& stretch : stretches) {
    if (stretch.line != chord.line) continue;
    if (stretch.begin < middle && middle < stretch.end) return &stretch;
    // past the joint of a closed line
    if (stretch.begin < middle + spans && middle + spans < stretch.end) return &stretch;
  }
  return nullptr;
}

}  // namespace anticrack::mesh
