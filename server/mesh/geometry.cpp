// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/at.hpp"
#include "mesh/geometry_boundary.hpp"
#include "mesh/geometry_primitives.hpp"
#include "mesh/geometry_steps.hpp"
#include "mesh/refine.hpp"

namespace anticrack::mesh {
namespace {

/// Gives the paper's square 5,700 triangles a subdomain, as many as the paper's mesh has.
constexpr double paper_growth = 0.057;

/// Without grading, the default size is a fiftieth of the diagonal. With grading, the paper's
/// square with its inclusion gets about as many triangles as the paper's mesh has.
constexpr double uniform_divisions = 50;
constexpr double graded_divisions = 20.3;

/// With many tips: h0 is the reach of a tip that has no more than its share, divided by this.
constexpr double share_divisions = 2.75;

/// Ratio of the default size of preset coarse to that of graded.
constexpr double coarsening = 4;

/// Limit of the curves of a plan; the work on them grows nearly quadratically.
constexpr std::size_t curve_limit = 50'000;

/// How many equilateral triangles of this edge length fill the area, or line its boundary.
double expected_triangles(double area, double size, double pieces) {
  return std::max(area / (std::sqrt(3.0) / 4 * size * size), pieces);
}

/// The number of ends of inclusions, of their delaminated parts, and of cracks.
std::size_t tip_count(const Geometry& geometry) {
  std::set<Point> ends;
  std::size_t within = 0;
  const auto add = [&](const Part& part) { ends.insert({part.from, part.to}); };
  for (const InclusionSpec& inclusion : geometry.inclusions) {
    add(inclusion.part);
    std::ranges::for_each(inclusion.delaminated, add);
    for (const StretchSpec& stretch : inclusion.stretches)
      within += (stretch.from > 0 ? 1 : 0) + (stretch.to < 1 ? 1 : 0);
  }
  for (const CrackSpec& crack : geometry.cracks) add(crack.part);
  return ends.size() + within;
}

/// The edge length if none is given.
double default_size(const Geometry& geometry, Preset preset, double across, double area) {
  if (!graded(preset)) return across / uniform_divisions;
  if (!(area > 0)) return across / graded_divisions;  // wrong holes are refused later
  const double share = tip_share(0.5 * std::sqrt(area), tip_count(geometry));
  const double size = std::min(across / graded_divisions, share / share_divisions);
  return preset == Preset::coarse ? coarsening * size : size;
}

/// The expected number as an integer; throws if it is above `max_triangles`.
std::size_t bounded(double expected, std::size_t max_triangles, const std::string& cause,
                    const std::string& field) {
  if (expected <= static_cast<double>(max_triangles)) return static_cast<std::size_t>(expected);
  throw errors::Error(errors::Reason::limit_exceeded,
                      "{} gives about {} triangles; at most {} are allowed, so choose a coarser "
                      "mesh (larger size or tip_size)",
                      cause, shown(std::round(expected)), max_triangles)
      .at(field);
}

/// Refuses a membrane that could move as a whole.
void check_held(const Geometry& geometry, const Plan& plan) {
  const auto held = [](const PlannedCurve& curve) { return curve.role == Role::dirichlet; };
  const auto fixed = [](const Motion& motion) { return motion.fixed.has_value(); };
  if (std::ranges::any_of(plan.curves, held) || std::ranges::any_of(plan.motions, fixed)) return;
  refuse(geometry.neumann_sides.empty() ? "neumann" : "neumann_sides",
         "all of the boundary is in neumann, so nothing holds the membrane and it could move as a "
         "whole; leave a side or a hole out of neumann, or hold an inclusion, as by fixed = 0");
}

/// Refuses inclusions and cracks beside which a piece of the membrane would be held in a single
/// point: the end of a side that is held, or a point of a held side in which two of them end.
void check_contacts(const Layout& layout, const Plan& plan) {
  struct Ends {
    int held = 0;   ///< boundary curves where u is held
    int free = 0;   ///< other boundary curves
    int parts = 0;  ///< curves of inclusions and cracks
  };
  std::vector<Ends> ends(plan.points.size());
  for (const PlannedCurve& curve : plan.curves) {
    for (const int point : {curve.a, curve.b}) {
      Ends& at_point = ends[at(point)];
      if (curve.role == Role::dirichlet) ++at_point.held;
      if (curve.role == Role::neumann) ++at_point.free;
      if (curve.role == Role::interface && curve.kind != Kind::glue) ++at_point.parts;
    }
  }
  for (const PlacedPart& part : layout.parts) {
    for (const bool end : {false, true}) {
      const int point = end ? part.end.point : part.begin.point;
      const Ends& there = ends[at(point)];
      if (there.held == 0 || (there.free == 0 && there.parts == 1)) continue;
      const std::string which = end != part.reversed ? ".to" : ".from";
      refuse(place_of(part) + (part.own ? "" : which), part.field, " ends at ",
             shown(plan.points[at(point)]),
             there.free > 0 ? " on the boundary, where u is held on one side of it only; end it "
                              "elsewhere, or name what lies on both sides in neumann, or none"
                            : " on the boundary, where u is held and another one ends; let them "
                              "end apart");
    }
  }
}

/// The stretch on which each chord of an interface lies, or null.
std::vector<const Stretch*> stretches_of(const Layout& layout, const Network& network) {
  std::vector<const Stretch*> stretches;
  stretches.reserve(network.chords.size());
  for (const Chord& chord : network.chords) {
    const bool interface = network.lines[at(chord.line)].role == Role::interface;
    stretches.push_back(interface ? stretch_of(layout.stretches, network, chord) : nullptr);
  }
  return stretches;
}

void add_curves(const Layout& layout, const Network& network,
                const std::vector<const Stretch*>& stretches, Plan& plan) {
  plan.points = network.points;
  plan.curves.reserve(network.chords.size());
  for (std::size_t e = 0; e < network.chords.size(); ++e) {
    const Chord& chord = network.chords[e];
    PlannedCurve curve;
    curve.a = chord.a;
    curve.b = chord.b;
    curve.role = network.lines[at(chord.line)].role;
    if (curve.role == Role::dirichlet && stretch_of(layout.neumann, network, chord) != nullptr)
      curve.role = Role::neumann;
    if (const Stretch* stretch = stretches[e]) {
      curve.kind = stretch->kind;
      curve.inclusion = stretch->inclusion;
    }
    plan.curves.push_back(curve);
  }
}

/// Notes the side or hole on which each curve of the boundary lies.
void add_sides(const Geometry& geometry, const Network& network, Plan& plan) {
  plan.sides = side_names(geometry);
  const std::size_t outer = plan.sides.size() - geometry.holes.size();
  for (std::size_t e = 0; e < network.chords.size(); ++e) {
    const Chord& chord = network.chords[e];
    const std::size_t line = at(chord.line);
    if (line >= network.boundary) continue;
    std::size_t side = line;
    if (line >= network.outer)
      side += outer - network.outer;
    else if (geometry.sides.empty())  // a polygon is one line, with an edge from each vertex
      side = static_cast<std::size_t>((chord.from + chord.to) / 2) % outer;
    if (line < network.outer && network.turned)
      side = (2 * outer - (geometry.sides.empty() ? 2 : 1) - side) % outer;
    plan.curves[e].side = static_cast<int>(side);
  }
}

/// Notes the bend of which each curve is a chord. A line has stations where its spans meet, so a
/// chord lies in one span.
void add_bends(const Network& network, Plan& plan) {
  std::pair<int, int> last{-1, -1};  // line and span
  for (std::size_t e = 0; e < network.chords.size(); ++e) {
    const Chord& chord = network.chords[e];
    const Line& line = network.lines[at(chord.line)].line;
    if (line.straight()) continue;
    const int span = static_cast<int>((chord.from + chord.to) / 2);
    if (last != std::pair(chord.line, span)) plan.bends.push_back(line.bend(span));
    last = {chord.line, span};
    PlannedCurve& curve = plan.curves[e];
    curve.bend = static_cast<int>(plan.bends.size()) - 1;
    curve.from = chord.from - span;
    curve.to = chord.to - span;
  }
}

/// How each chord must be walked: the numerics let the minus side come off, and the plus side of a
/// crack is the left side of the user's line.
std::vector<Walk> walks_of(const std::vector<const Stretch*>& stretches) {
  std::vector<Walk> walks;
  walks.reserve(stretches.size());
  for (const Stretch* stretch : stretches) {
    const bool directed = stretch != nullptr && stretch->kind != Kind::inclusion;
    walks.push_back(!directed           ? Walk::either
                    : stretch->plus_off ? Walk::reversed
                                        : Walk::as_written);
  }
  return walks;
}

void check_for_paper(const Geometry& geometry, const Plan& plan) {
  const bool one = geometry.interfaces.size() == 1 && geometry.sides.empty() &&
                   geometry.holes.empty() && geometry.interfaces[0].shape == Shape::polyline &&
                   !geometry.interfaces[0].closed && plan.interfaces.size() == 1 &&
                   plan.faces.size() == 2 && plan.faces[0].embedded.empty() &&
                   plan.faces[1].embedded.empty();
  if (one) return;
  throw errors::Error(errors::Reason::invalid_argument,
                      "preset paper is for one polyline that cuts the polygon in two from "
                      "boundary to boundary; choose preset graded or uniform for this geometry")
      .at("options.preset");
}

void plan_paper(double area, std::size_t max_triangles, Plan& plan) {
  plan.growth = paper_growth;
  set_paper_intervals(plan);
  double pieces = 0;
  double longest = 0;
  for (const PlannedCurve& curve : plan.curves) {
    pieces += curve.intervals;
    longest = std::max(longest, length_of(plan, curve) / curve.intervals);
  }
  plan.triangles = bounded(expected_triangles(area, longest, pieces), max_triangles, "preset paper",
                           "options.preset");
}

/// Checks before anything is cut that the area and the lines need at most `max_triangles`.
std::size_t check_size(const Network& network, double area, double size,
                       std::size_t max_triangles) {
  double pieces = 0;
  for (const NetworkLine& line : network.lines) pieces += line.line.length() / size;
  return bounded(expected_triangles(area, size, pieces), max_triangles,
                 "an edge length of " + shown(size), "options.size");
}

/// Adds a warning with the largest distance of chords from their curve.
void note_chords(const Network& network, std::vector<std::string>& warnings) {
  std::vector<int> pieces(network.lines.size());
  double most = 0;
  std::size_t worst = 0;
  for (const Chord& chord : network.chords) {
    const NetworkLine& on = network.lines[at(chord.line)];
    if (on.line.straight()) continue;
    ++pieces[at(chord.line)];
    const Point& a = network.points[at(chord.a)];
    const Point& b = network.points[at(chord.b)];
    const auto curve = [&](double t) { return on.line.at(on.line.on_line(t)); };
    const double off = std::max(
        distance(curve(chord.to), b),
        distance(curve((chord.from + chord.to) / 2), Point{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}));
    if (off > most) worst = at(chord.line);
    most = std::max(most, off);
  }
  if (most == 0) return;
  const auto curves = std::ranges::count_if(pieces, [](int count) { return count > 0; });
  warnings.push_back(fmt::format(
      "{} replaced by chords: {}{} by {}, up to {:.2g} off the curve; bounds are those of the "
      "membrane with chords, what curves would change is estimated beside them, and half the "
      "mesh.chord_angle (default 5) makes it an eighth",
      curves == 1 ? "a curve is" : "curves are", network.lines[worst].field.shown,
      curves == 1 ? "" : fmt::format(", the coarsest of {} curves,", curves), pieces[worst], most));
}

}  // namespace

Plan plan(const Geometry& given, const MeshOptions& options, std::size_t max_triangles) {
  check_for_geometry(options);
  Drawn geometry = draw(given);
  Network network = lay_lines(geometry, options, curve_limit);
  Plan plan;
  if (snap_ends(network, geometry, plan.warnings))
    network = lay_lines(geometry, options, curve_limit);
  const std::vector<std::string> names = check_names(geometry);
  const double area = area_of(network);
  const double across = diagonal(outer_polygon(network));
  if (options.size > across) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "an edge length of {} is more than the membrane, which is {} across; write "
                        "a smaller one, or leave it out for its default",
                        shown(options.size), shown(across))
        .at("options.size");
  }
  const double size =
      options.size > 0 ? options.size : default_size(geometry, options.preset, across, area);
  std::size_t triangles = 0;
  if (options.preset != Preset::paper) triangles = check_size(network, area, size, max_triangles);
  // The lines are cut alone first, so that their faults are not reported as faults of their parts.
  Network lines = network;
  ChordRule rule{size};
  if (options.chord_angle > 0) rule.turn = options.chord_angle * std::numbers::pi / 180;
  cut(lines, rule, curve_limit);
  const Layout layout = lay_parts(geometry, network);
  for (const Stretch& part : layout.stretches)
    network.lines[at(part.line)].parts.push_back({part.begin, part.end});
  cut(network, rule, curve_limit);
  balance_areas(network);
  if (options.chord_angle == 0) note_chords(network, plan.warnings);

  plan.triangles = triangles;
  for (const InclusionSpec& inclusion : geometry.inclusions) {
    plan.inclusions.push_back(inclusion.name);
    plan.motions.push_back(inclusion.motion);
  }
  const std::vector<const Stretch*> stretches = stretches_of(layout, network);
  add_curves(layout, network, stretches, plan);
  add_sides(geometry, network, plan);
  add_bends(network, plan);
  check_held(geometry, plan);
  check_contacts(layout, plan);
  lay_subdomains(geometry, network, names, walks_of(stretches), plan);
  if (options.preset == Preset::paper) {
    check_for_paper(geometry, plan);
    plan_paper(area, max_triangles, plan);
    return plan;
  }
  cut_near(plan, size, plan.growth, curve_limit);
  set_intervals(plan, size);
  if (graded(options.preset)) plan.grading = {size, options.grading, options.tip_size};
  return plan;
}

}  // namespace anticrack::mesh
