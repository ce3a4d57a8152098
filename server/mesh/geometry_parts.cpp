// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "mesh/geometry_outline.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/names.hpp"

namespace anticrack::mesh {
namespace {

/// An end of a part, found on the interface.
struct PlacedPart {
  Station begin;
  Station end;
  std::string field;  ///< of the inclusion, crack or delaminated part
};

struct Line {
  const std::vector<Point>& points;
  std::vector<double> s;  ///< arc length of each vertex
  double tolerance = 0;

  double length() const { return s.back(); }
};

Line measure(const std::vector<Point>& points) {
  Line line{points, {0.0}, 0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    line.s.push_back(line.s.back() + distance(points[i - 1], points[i]));
  }
  line.tolerance = relative_tolerance * line.length();
  return line;
}

Station locate(const Line& line, const Point& p, const std::string& field) {
  check_point(p, field);
  std::size_t best = 0;
  double off = distance(p, Segment{line.points[0], line.points[1]});
  for (std::size_t i = 1; i + 1 < line.points.size(); ++i) {
    const double d = distance(p, Segment{line.points[i], line.points[i + 1]});
    if (d < off) {
      off = d;
      best = i;
    }
  }
  if (off > line.tolerance) {
    refuse(field, field, " ", show(p), " lies ", show(off),
           " off the interface; it must lie on it, to ", show(line.tolerance));
  }
  for (const std::size_t i : {best, best + 1}) {
    if (distance(p, line.points[i]) <= line.tolerance) return {line.s[i], line.points[i]};
  }
  const double t = nearest(p, Segment{line.points[best], line.points[best + 1]});
  return {line.s[best] + t * (line.s[best + 1] - line.s[best]), p};
}

/// `field` names the part itself ("cracks[0].part"), `owner` what it belongs to.
PlacedPart place(const Line& line, const Part& part, const std::string& field,
                 const std::string& owner) {
  PlacedPart placed{locate(line, part.from, field + ".from"), locate(line, part.to, field + ".to"),
                    owner};
  if (std::abs(placed.end.s - placed.begin.s) <= line.tolerance) {
    refuse(field, field, " has no length: it runs from ", show(part.from), " to ", show(part.to));
  }
  if (placed.begin.s > placed.end.s) std::swap(placed.begin, placed.end);
  return placed;
}

void refuse_at_ends(const Line& line, const Part& part, const PlacedPart& placed,
                    const std::string& field) {
  const auto check = [&](const Station& tip) {
    if (tip.s > line.tolerance && tip.s < line.length() - line.tolerance) return;
    const bool is_from = distance(tip.point, part.from) <= line.tolerance;
    const std::string at = field + (is_from ? ".from" : ".to");
    refuse(at, at, " ", show(tip.point),
           " touches the boundary, at an end of the interface; a tip must lie inside the membrane");
  };
  check(placed.begin);
  check(placed.end);
}

void check_names(const Geometry& geometry) {
  std::map<std::string, std::string> used;
  const auto check = [&](const std::string& name, const std::string& owner) {
    const std::string field = owner + ".name";
    if (!valid_name(name)) {
      // what is quoted goes into messages and logs
      const bool printable =
          std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
      refuse(field, field, " is ",
             name.empty()       ? "empty"
             : !printable       ? "not printable"
             : name.size() > 64 ? "of " + std::to_string(name.size()) + " characters"
                                : "\"" + name + "\"",
             "; a name is ", name_rule);
    }
    const auto [entry, added] = used.emplace(name, owner);
    if (!added) {
      refuse(field, field, " \"", name, "\" is already the name of ", entry->second,
             "; every inclusion and crack needs its own");
    }
  };
  for (std::size_t i = 0; i < geometry.inclusions.size(); ++i) {
    check(geometry.inclusions[i].name, indexed("inclusions", i));
  }
  for (std::size_t i = 0; i < geometry.cracks.size(); ++i) {
    check(geometry.cracks[i].name, indexed("cracks", i));
  }
}

void check_count(std::size_t count, const std::string& field) {
  if (count <= max_vertices) return;
  throw errors::Error(errors::Reason::limit_exceeded,
                      field + " has " + std::to_string(count) + " entries; at most " +
                          std::to_string(max_vertices) + " are taken")
      .at(field);
}

bool by_begin(const PlacedPart& a, const PlacedPart& b) {
  return a.begin.s < b.begin.s;
}

void check_apart(std::vector<PlacedPart> parts, double tolerance) {
  std::stable_sort(parts.begin(), parts.end(), by_begin);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const PlacedPart& left = parts[i - 1];
    const PlacedPart& right = parts[i];
    if (right.begin.s > left.end.s + tolerance) continue;
    const std::string field = right.field + ".part";
    if (right.begin.s >= left.end.s - tolerance) {
      refuse(field, right.field, " and ", left.field, " share the tip ", show(right.begin.point),
             "; the membrane is tied to both at a common tip, so leave glue between them or make "
             "them one");
    }
    refuse(field, right.field, " and ", left.field, " overlap from ", show(right.begin.point),
           " on; a piece of the interface belongs to one inclusion or crack");
  }
}

/// The delaminated parts of an inclusion, in order, held against the ends of the inclusion.
std::vector<PlacedPart> place_delaminated(const Line& line, const InclusionSpec& inclusion,
                                          const PlacedPart& whole) {
  const std::string list = whole.field + ".delaminated_parts";
  check_count(inclusion.delaminated.size(), list);
  std::vector<PlacedPart> parts;
  for (std::size_t k = 0; k < inclusion.delaminated.size(); ++k) {
    const std::string field = indexed(list, k);
    const Part& part = inclusion.delaminated[k];
    for (const auto& [end, point] : {std::pair(".from", part.from), std::pair(".to", part.to)}) {
      const std::string at = field + end;
      const double s = locate(line, point, at).s;
      if (s < whole.begin.s - line.tolerance || s > whole.end.s + line.tolerance) {
        refuse(at, at, " ", show(point), " lies outside its inclusion, which runs from ",
               show(whole.begin.point), " to ", show(whole.end.point));
      }
    }
    PlacedPart placed = place(line, part, field, field);
    if (placed.begin.s <= whole.begin.s + line.tolerance) placed.begin = whole.begin;
    if (placed.end.s >= whole.end.s - line.tolerance) placed.end = whole.end;
    parts.push_back(std::move(placed));
  }
  std::stable_sort(parts.begin(), parts.end(), by_begin);
  for (std::size_t k = 1; k < parts.size(); ++k) {
    if (parts[k].begin.s > parts[k - 1].end.s + line.tolerance) continue;
    refuse(parts[k].field, parts[k].field, " and ", parts[k - 1].field, " overlap or touch at ",
           show(parts[k].begin.point), "; make them one part");
  }
  return parts;
}

/// Bonded and delaminated stretches of one inclusion.
void add_inclusion(const PlacedPart& whole, const std::vector<PlacedPart>& delaminated, int index,
                   InterfaceLayout& layout) {
  double at = whole.begin.s;
  for (const PlacedPart& part : delaminated) {
    if (part.begin.s > at) {
      layout.stretches.push_back({at, part.begin.s, Kind::inclusion, index});
    }
    layout.stretches.push_back({part.begin.s, part.end.s, Kind::delaminated, index});
    layout.stations.push_back(part.begin);
    layout.stations.push_back(part.end);
    at = part.end.s;
  }
  if (at < whole.end.s) layout.stretches.push_back({at, whole.end.s, Kind::inclusion, index});
}

/// A tip that was snapped to a vertex, or to the tip of its inclusion, is there twice.
void sort_and_merge(std::vector<Station>& stations) {
  std::stable_sort(stations.begin(), stations.end(),
                   [](const Station& a, const Station& b) { return a.s < b.s; });
  const auto end = std::unique(stations.begin(), stations.end(),
                               [](const Station& a, const Station& b) { return a.s == b.s; });
  stations.erase(end, stations.end());
}

}  // namespace

InterfaceLayout lay_out(const Geometry& geometry) {
  check_count(geometry.inclusions.size(), "inclusions");
  check_count(geometry.cracks.size(), "cracks");
  check_names(geometry);
  const Line line = measure(geometry.interfaces.front().points);
  InterfaceLayout layout;
  for (std::size_t i = 0; i < geometry.interfaces.front().points.size(); ++i) {
    layout.stations.push_back({line.s[i], geometry.interfaces.front().points[i]});
  }
  std::vector<PlacedPart> placed;
  const auto add = [&](const Part& part, const std::string& owner) {
    const std::string field = owner + ".part";
    placed.push_back(place(line, part, field, owner));
    refuse_at_ends(line, part, placed.back(), field);
    layout.stations.push_back(placed.back().begin);
    layout.stations.push_back(placed.back().end);
  };
  for (std::size_t i = 0; i < geometry.inclusions.size(); ++i) {
    const InclusionSpec& inclusion = geometry.inclusions[i];
    add(inclusion.part, indexed("inclusions", i));
    add_inclusion(placed.back(), place_delaminated(line, inclusion, placed.back()),
                  static_cast<int>(i), layout);
  }
  for (std::size_t i = 0; i < geometry.cracks.size(); ++i) {
    add(geometry.cracks[i].part, indexed("cracks", i));
    layout.stretches.push_back({placed.back().begin.s, placed.back().end.s, Kind::crack, -1});
  }
  check_apart(placed, line.tolerance);
  std::sort(layout.stretches.begin(), layout.stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
  sort_and_merge(layout.stations);
  return layout;
}

}  // namespace anticrack::mesh
