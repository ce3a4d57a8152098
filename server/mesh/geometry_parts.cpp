// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_steps.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "mesh/at.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

struct Ends {
  int from = 0;  ///< points of the network
  int to = 0;
};

/// Lines of a role that have a station at a point.
std::vector<int> lines_at(const Network& network, Role role, int point) {
  std::vector<int> lines;
  for (std::size_t l = 0; l < network.lines.size(); ++l) {
    const NetworkLine& line = network.lines[l];
    if (line.role == role && station_of(line, point) >= 0) lines.push_back(static_cast<int>(l));
  }
  return lines;
}

void refuse_off(const Network& network, const Point& p, const std::string& field) {
  double off = std::numeric_limits<double>::infinity();
  const Line* nearest = nullptr;
  for (const NetworkLine& line : network.lines) {
    if (line.role != Role::interface) continue;
    const double d = line.line.distance_to(p);
    if (d < off) nearest = &line.line;
    off = std::min(off, d);
  }
  if (nearest == nullptr)
    refuse(field, field, " ", show(p), " lies on no interface: there is none");
  const std::optional<double> t = nearest->locate(p, 1.01 * off);
  refuse(field, field, " ", show(p), " lies ", show(off),
         " off the interface; it must lie on it, to ", show(snap_distance(network)),
         t ? "; nearest is " + show(nearest->at(*t)) : "");
}

Ends mark_ends(Network& network, const Part& part) {
  return {mark(network, part.from), mark(network, part.to)};
}

/// The interface both ends of a part lie on.
int line_of(const Network& network, const Part& part, const Ends& ends, const std::string& field) {
  const std::vector<int> from = lines_at(network, Role::interface, ends.from);
  const std::vector<int> to = lines_at(network, Role::interface, ends.to);
  if (from.empty()) refuse_off(network, part.from, field + ".from");
  if (to.empty()) refuse_off(network, part.to, field + ".to");
  if (ends.from == ends.to)
    refuse(field, field, " has no length: it runs from ", show(part.from), " to ", show(part.to));
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

/// The stations of a part on its line, in order.
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

/// The delaminated parts of an inclusion, in order.
std::vector<PlacedPart> place_delaminated(Network& network, const InclusionSpec& inclusion,
                                          const PlacedPart& whole) {
  const std::string list = whole.field + ".delaminated_parts";
  check_count(inclusion.delaminated.size(), list);
  std::vector<PlacedPart> parts;
  parts.reserve(inclusion.delaminated.size());
  const Point begin = network.points[at(whole.begin.point)];
  const Point end = network.points[at(whole.end.point)];
  for (std::size_t k = 0; k < inclusion.delaminated.size(); ++k) {
    const std::string field = indexed(list, k);
    const Part& part = inclusion.delaminated[k];
    const Ends ends = mark_ends(network, part);
    const NetworkLine& line = network.lines[at(whole.line)];
    const auto within = [&](int point, const Point& p, const char* which) {
      double t = station_of(line, point);
      if (t < 0) refuse_off(network, p, field + which);
      if (t < whole.begin.t) t += line.line.closed() ? line.line.spans() : 0;
      if (t < whole.begin.t || t > whole.end.t)
        refuse(field + which, field, which, " ", show(p),
               " lies outside its inclusion, which runs from ", show(begin), " to ", show(end));
      return Station{t, point};
    };
    PlacedPart placed;
    placed.begin = within(ends.from, part.from, ".from");
    placed.end = within(ends.to, part.to, ".to");
    if (ends.from == ends.to)
      refuse(field, field, " has no length: it runs from ", show(part.from), " to ", show(part.to));
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
           show(network.points[at(parts[k].begin.point)]), "; make them one part");
  }
  return parts;
}

/// Bonded and delaminated stretches of one inclusion.
void add_inclusion(const PlacedPart& whole, const std::vector<PlacedPart>& delaminated,
                   Layout& layout) {
  double at = whole.begin.t;
  const auto add = [&](double end, Kind kind) {
    if (end > at) layout.stretches.push_back({whole.line, at, end, kind, whole.inclusion});
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
  const std::string field = right.field + ".part";
  const std::string place = show(network.points[at(right.begin.point)]);
  if (begin == left.end.t) {
    refuse(field, right.field, " and ", left.field, " share the tip ", place,
           "; the membrane is tied to both at a common tip, so leave glue between them or make "
           "them one");
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

std::vector<Stretch> lay_neumann(const Geometry& geometry, Network& network) {
  struct Placed {
    Stretch stretch;
    std::string field;
  };
  std::vector<Placed> placed;
  placed.reserve(geometry.neumann.size());
  const double spans = network.lines.front().line.spans();
  for (std::size_t i = 0; i < geometry.neumann.size(); ++i) {
    const std::string field = indexed("neumann", i);
    const Part& part = geometry.neumann[i];
    const Ends ends = mark_ends(network, part);
    const auto on_boundary = [&](int point, const Point& p, const char* which) {
      const double t = station_of(network.lines.front(), point);
      if (t >= 0) return t;
      refuse(field + which, field, which, " ", show(p), " lies ",
             show(network.lines.front().line.distance_to(p)),
             " off the boundary; it must lie on it, to ", show(snap_distance(network)));
    };
    const double begin = on_boundary(ends.from, part.from, ".from");
    double end = on_boundary(ends.to, part.to, ".to");
    if (end <= begin) end += spans;
    placed.push_back({{0, begin, end, Kind::glue, -1}, field});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.stretch.begin < b.stretch.begin;
  });
  std::vector<Stretch> stretches;
  stretches.reserve(placed.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    stretches.push_back(placed[i].stretch);
    if (placed.size() == 1) break;
    const Placed& next = placed[(i + 1) % placed.size()];
    const double shift = i + 1 == placed.size() ? spans : 0;
    if (next.stretch.begin + shift < placed[i].stretch.end)
      refuse(next.field, next.field, " and ", placed[i].field, " overlap; make them one part");
  }
  return stretches;
}

}  // namespace

Layout lay_parts(const Geometry& geometry, Network& network) {
  Layout layout;
  layout.parts.reserve(geometry.inclusions.size() + geometry.cracks.size());
  const auto add = [&](const Part& part, const std::string& owner, int inclusion) {
    const std::string field = owner + ".part";
    const Ends ends = mark_ends(network, part);
    PlacedPart placed = place(network, line_of(network, part, ends, field), ends);
    placed.field = owner;
    placed.inclusion = inclusion;
    layout.parts.push_back(std::move(placed));
  };
  for (std::size_t i = 0; i < geometry.inclusions.size(); ++i) {
    add(geometry.inclusions[i].part, indexed("inclusions", i), static_cast<int>(i));
    const PlacedPart& whole = layout.parts.back();
    add_inclusion(whole, place_delaminated(network, geometry.inclusions[i], whole), layout);
    const std::string fault = fault_of(geometry.inclusions[i].motion);
    if (!fault.empty()) refuse(whole.field + ".fixed", whole.field, ": ", fault);
  }
  for (std::size_t i = 0; i < geometry.cracks.size(); ++i) {
    add(geometry.cracks[i].part, indexed("cracks", i), -1);
    const PlacedPart& placed = layout.parts.back();
    const Kind kind = geometry.cracks[i].contact ? Kind::crack : Kind::free;
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
