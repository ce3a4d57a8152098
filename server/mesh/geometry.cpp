// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "mesh/geometry_intervals.hpp"
#include "mesh/geometry_outline.hpp"
#include "mesh/geometry_parts.hpp"
#include "mesh/geometry_primitives.hpp"

namespace anticrack::mesh {
namespace {

/// Section 8 of the paper: 80 intervals on gamma_c, on gamma_g and on the outer boundary of each
/// subdomain.
constexpr int paper_intervals = 80;

/// Gives the square of the paper 5,700 triangles a subdomain, as many as its mesh has.
constexpr double paper_growth = 0.057;

double length_of(const Plan& plan, const PlannedCurve& curve) {
  return distance(plan.points[static_cast<std::size_t>(curve.a)],
                  plan.points[static_cast<std::size_t>(curve.b)]);
}

int add_point(Plan& plan, const Point& p) {
  plan.points.push_back(p);
  return static_cast<int>(plan.points.size()) - 1;
}

void add_interface(Plan& plan, const InterfaceLayout& layout, const std::string& name) {
  int before = add_point(plan, layout.stations.front().point);
  std::size_t next = 0;  // the first stretch that does not end before the curve
  PlannedInterface chain{name, {}};
  for (std::size_t i = 1; i < layout.stations.size(); ++i) {
    const double middle = (layout.stations[i - 1].s + layout.stations[i].s) / 2;
    PlannedCurve curve;
    curve.role = Role::interface;
    curve.left = 1;
    curve.right = 0;
    curve.a = before;
    curve.b = before = add_point(plan, layout.stations[i].point);
    while (next < layout.stretches.size() && layout.stretches[next].end < middle) ++next;
    if (next < layout.stretches.size() && layout.stretches[next].begin < middle) {
      curve.kind = layout.stretches[next].kind;
      curve.inclusion = layout.stretches[next].inclusion;
    }
    chain.curves.push_back(static_cast<int>(plan.curves.size()));
    plan.curves.push_back(curve);
  }
  plan.interfaces.push_back(std::move(chain));
}

void add_outer(Plan& plan, const Outline& outline) {
  const std::vector<int> chain = plan.interfaces.front().curves;
  const int start = plan.curves[static_cast<std::size_t>(chain.front())].a;
  const int end = plan.curves[static_cast<std::size_t>(chain.back())].b;
  plan.faces.resize(2);
  plan.faces[0].name = "omega1";
  plan.faces[1].name = "omega2";
  const auto walk = [&](int face, int first, const BoundaryPlace& from, int last,
                        const BoundaryPlace& to) {
    int before = first;
    const auto add = [&](int next) {
      PlannedCurve curve;
      curve.a = before;
      curve.b = before = next;
      curve.left = face;
      plan.curves.push_back(curve);
      plan.faces[static_cast<std::size_t>(face)].outer.push_back(
          static_cast<int>(plan.curves.size()));
    };
    for (const std::size_t v : vertices_between(from, to, outline.boundary.size())) {
      add(add_point(plan, outline.boundary[v]));
    }
    add(last);
  };
  // The minus side lies right of the interface: counterclockwise around it, the outer boundary runs
  // from the interface's start to its end.
  walk(0, start, outline.start, end, outline.end);
  walk(1, end, outline.end, start, outline.start);
  for (const int curve : chain) plan.faces[1].outer.push_back(curve + 1);
  for (auto c = chain.rbegin(); c != chain.rend(); ++c) plan.faces[0].outer.push_back(-*c - 1);
}

/// Calls `visit` for each curve of the plan.
void each_curve(Plan& plan, const std::function<void(PlannedCurve&)>& visit) {
  for (PlannedCurve& curve : plan.curves) visit(curve);
}

void share(const Plan& plan, const std::vector<PlannedCurve*>& curves) {
  if (curves.empty()) return;
  std::vector<double> lengths;
  lengths.reserve(curves.size());
  for (const PlannedCurve* curve : curves) lengths.push_back(length_of(plan, *curve));
  const std::vector<int> shares = apportion(lengths, paper_intervals);
  for (std::size_t i = 0; i < curves.size(); ++i) curves[i]->intervals = shares[i];
}

void set_paper_intervals(Plan& plan) {
  std::vector<PlannedCurve*> glue;
  std::vector<PlannedCurve*> rest;
  std::array<std::vector<PlannedCurve*>, 2> outer;
  for (PlannedCurve& curve : plan.curves) {
    if (curve.role == Role::interface) {
      (curve.kind == Kind::glue ? glue : rest).push_back(&curve);
    } else {
      outer[static_cast<std::size_t>(curve.left)].push_back(&curve);
    }
  }
  share(plan, glue);
  share(plan, rest);
  for (const auto& curves : outer) share(plan, curves);
}

double uniform_pieces(const Plan& plan, const PlannedCurve& curve, double size) {
  // a length that is a whole number of sizes but for rounding is cut into just as many
  return std::max(1.0, std::ceil(length_of(plan, curve) / size - 1e-9));
}

/// Equilateral triangles of this edge length fill the area, or line its boundary.
double expected_triangles(double area, double size, double pieces) {
  return std::max(area / (std::sqrt(3.0) / 4 * size * size), pieces);
}

void refuse_too_many(double expected, std::size_t max_triangles, const std::string& cause,
                     const std::string& field) {
  if (expected <= static_cast<double>(max_triangles)) return;
  throw errors::Error(errors::Reason::limit_exceeded,
                      cause + " gives about " + show(std::round(expected)) +
                          " triangles; at most " + std::to_string(max_triangles) +
                          " are taken, so choose a coarser mesh")
      .at(field);
}

void set_uniform_intervals(Plan& plan, double size, double area, std::size_t max_triangles) {
  double pieces = 0;
  each_curve(plan, [&](PlannedCurve& curve) { pieces += uniform_pieces(plan, curve, size); });
  refuse_too_many(expected_triangles(area, size, pieces), max_triangles,
                  "an edge length of " + show(size), "options.size");
  each_curve(plan, [&](PlannedCurve& curve) {
    curve.intervals = static_cast<int>(uniform_pieces(plan, curve, size));
  });
}

void check_options(const MeshOptions& options) {
  if (!std::isfinite(options.size) || options.size < 0) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "options.size is " + show(options.size) +
                            "; it is an edge length above 0, or 0 for the default")
        .at("options.size");
  }
  if (options.preset == Preset::paper && options.size > 0) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "options.size is " + show(options.size) +
                            ", but preset paper fixes the intervals; leave it 0, or choose "
                            "preset uniform")
        .at("options.size");
  }
}

}  // namespace

Plan plan(const Geometry& geometry, const MeshOptions& options, std::size_t max_triangles) {
  check_options(options);
  const Outline outline = check_outline(geometry);
  const InterfaceLayout layout = lay_out(geometry);
  Plan plan;
  add_interface(plan, layout, geometry.interfaces.front().name);
  add_outer(plan, outline);
  for (const InclusionSpec& inclusion : geometry.inclusions) {
    plan.inclusions.push_back(inclusion.name);
  }
  const double area = std::abs(signed_area(outline.boundary));
  if (options.preset != Preset::paper) {
    const bool graded = options.preset == Preset::graded;
    const double size =
        options.size > 0 ? options.size : diagonal(outline.boundary) / (graded ? 22 : 50);
    if (graded) plan.grading = {size, options.grading, options.tip_size};
    set_uniform_intervals(plan, size, area, max_triangles);
    return plan;
  }
  plan.growth = paper_growth;
  set_paper_intervals(plan);
  double pieces = 0;
  double longest = 0;
  each_curve(plan, [&](PlannedCurve& curve) {
    pieces += curve.intervals;
    longest = std::max(longest, length_of(plan, curve) / curve.intervals);
  });
  refuse_too_many(expected_triangles(area, longest, pieces), max_triangles, "preset paper",
                  "options.preset");
  return plan;
}

void check_for_upload(const MeshOptions& options) {
  check_options(options);
}

}  // namespace anticrack::mesh
