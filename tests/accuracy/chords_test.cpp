// SPDX-License-Identifier: GPL-3.0-or-later
//
// Curves and their chords: what chords change of energies and displacements, and its estimate,
// against closed solutions of discs and annuli, and of arcs against a quarter of the angle.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/base_meshes.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine_uniform.hpp"

namespace anticrack::accuracy {
namespace {

using mesh::OutlineSpec;
using mesh::Shape;
using std::numbers::pi;

/// The unit disc.
mesh::Geometry disc() {
  mesh::Geometry geometry;
  geometry.sides = {{"lower", {Shape::arc, {{-1, 0}, {0, -1}, {1, 0}}}},
                    {"upper", {Shape::arc, {{1, 0}, {0, 1}, {-1, 0}}}}};
  return geometry;
}

mesh::Geometry ring(double inner) {
  mesh::Geometry geometry = disc();
  geometry.holes = {{"hole", {Shape::circle, {{0, 0}}, inner}}};
  return geometry;
}

mesh::InclusionSpec on_arc(const std::string& name, std::vector<mesh::Point> points) {
  mesh::InclusionSpec inclusion{name, {}, {}};
  inclusion.line = mesh::LineSpec{Shape::arc, std::move(points)};
  return inclusion;
}

/// Two half circles that are one rigid ring.
mesh::Geometry stiff_ring(double radius, bool tilt) {
  mesh::Geometry geometry = disc();
  geometry.inclusions = {on_arc("lower", {{-radius, 0}, {0, -radius}, {radius, 0}}),
                         on_arc("upper", {{radius, 0}, {0, radius}, {-radius, 0}})};
  for (mesh::InclusionSpec& half : geometry.inclusions) half.motion.tilt = tilt;
  return geometry;
}

/// Of the membrane with chords, and what curves in their place change by the estimate, on a mesh
/// with few edges on each chord and on one with many.
struct Values {
  double energy = 0, a = 0;
  double energy_gap[2] = {}, a_gap[2] = {};
};

/// The values of finer and finer meshes of one polygon, of which errors of h^2 are taken off.
Values on_chords(const mesh::Geometry& geometry, const fem::Load& load,
                 const mesh::MeshOptions& options, int halvings) {
  mesh::Mesh mesh = generated(geometry, options);
  Values values;
  double energy = 0, a = 0;
  for (int level = 0; level <= halvings; ++level) {
    if (level > 0) mesh = mesh::refine_uniform(mesh);
    const contact::Answer answer = solve_bounded(*factorise(mesh), load);
    const double found = answer.energy_mesh,
                 moved = answer.inclusions.empty() ? 0 : answer.inclusions[0].displacement_mesh;
    values.energy = (4 * found - energy) / 3;
    values.a = (4 * moved - a) / 3;
    energy = found;
    a = moved;
    const std::size_t many = level > 0 ? 1 : 0;
    values.energy_gap[many] = answer.energy_geometry_error.value();
    if (!answer.inclusions.empty())
      values.a_gap[many] = answer.inclusions[0].displacement_geometry_error.value();
  }
  return values;
}

mesh::MeshOptions with_chords(mesh::Preset preset, double size, double angle) {
  mesh::MeshOptions options{preset, size};
  options.chord_angle = angle;
  return options;
}

fem::Load pushed(double f, const std::string& boundary = "") {
  fem::Load load;
  load.force = f;
  load.boundary_value = boundary;
  return load;
}

/// A membrane of circles with the radii 1 and r. Energy and A for any radii R and r; A 0: it has
/// none.
struct Case {
  const char* name;
  mesh::Geometry geometry;
  fem::Load load;
  std::function<double(double, double)> energy, a = [](double, double) { return 0.; };
  double r = 0.25;
};

std::vector<Case> closed_solutions() {
  std::vector<Case> cases;
  const auto half_a = [](const auto& a) {
    return [a](double R, double r) { return -a(R, r) / 2; };
  };
  cases.push_back(
      {"disc", disc(), pushed(1), [](double R, double) { return -pi * std::pow(R, 4) / 16; }});
  cases.push_back({"ring", ring(0.25), pushed(0, "x^2 + y^2 < 0.25 ? 1 : 0"),
                   [](double R, double r) { return pi / std::log(R / r); }});
  cases.push_back(
      {"driven", ring(0.25), pushed(0, "x^2 + y^2 < 0.25 ? 0 : x"),
       [](double R, double r) { return pi / 2 * R * R * (R * R + r * r) / (R * R - r * r); }});
  cases.push_back({"pulled", ring(0.25), pushed(0),
                   [](double R, double r) { return -pi * r * r * std::log(R / r); }});
  cases.back().geometry.neumann_sides = {"hole"};
  cases.back().load.traction = "1";
  constexpr double t = 3;  // tension of a core
  Case core{"core", disc(), pushed(1), [](double R, double r) {
              const double s = r * r, d = R * R - s;
              return -pi / 2 * (d * d / 8 + s * d / 4 + s * s / (8 * t));
            }};
  core.r = 0.5;
  core.geometry.regions = {{"core", {}, t, OutlineSpec{Shape::circle, {{0, 0}}, core.r}}};
  cases.push_back(core);
  core.name = "drawn core";
  core.load = pushed(0, "x");
  core.energy = [](double R, double r) {
    const double out = (1 - t) / (1 + t) * r * r / (R * R);
    return pi / 2 * R * R * (1 - out) / (1 + out);
  };
  cases.push_back(core);
  Case stiff{"stiff ring", stiff_ring(0.5, false), pushed(0), {}};
  stiff.r = 0.5;
  stiff.load.inclusion_forces = {{"lower", 1}};
  stiff.a = [](double R, double r) { return std::log(R / r) / (2 * pi); };
  stiff.energy = half_a(stiff.a);
  cases.push_back(stiff);
  Case tilted{"tilted ring", stiff_ring(0.5, true), pushed(0),
              half_a([](double R, double r) { return (1 / (r * r) - 1 / (R * R)) / (2 * pi); })};
  tilted.r = 0.5;
  tilted.load.inclusion_moments = {{"lower", {1, 0}}};
  cases.push_back(tilted);
  return cases;
}

void expect_estimate(const std::string& what, double off, const double (&gap)[2]) {
  std::printf("[ figures  ] %s off by %9.2e, the estimate %4.2f and %4.2f of this\n", what.c_str(),
              off, gap[0] / std::abs(off), gap[1] / std::abs(off));
  for (const double one : gap) {
    EXPECT_GE(one, std::abs(off)) << what;
    EXPECT_LE(one, 5 * std::abs(off)) << what;
  }
}

TEST(Chords, AreEstimatedOnDiscsAndRings) {
  for (const Case& one : closed_solutions()) {
    for (const double angle : {10., 4., 1.6}) {
      const Values values =
          on_chords(one.geometry, one.load, with_chords(mesh::Preset::uniform, 0.2, angle), 3);
      const std::string at = fmt::format("{} at {} degrees: ", one.name, angle);
      expect_estimate(at + "energy", values.energy - one.energy(1, one.r), values.energy_gap);
      if (const double a = one.a(1, one.r); a != 0)
        expect_estimate(at + "A", values.a - a, values.a_gap);
    }
  }
}

/// The mesh as if its outer circle, or the inner one, were larger than it is.
mesh::Mesh with_larger(mesh::Mesh mesh, bool outer, double by) {
  for (mesh::ChordEdge& edge : mesh.chords) {
    const mesh::Point a = mesh::position(mesh, edge.a), b = mesh::position(mesh, edge.b);
    if ((std::hypot(a[0], a[1]) > 0.75) != outer) continue;
    const double left = a[0] * b[1] - a[1] * b[0] > 0 ? -by : by;
    edge.at_a += left;
    edge.at_middle += left;
    edge.at_b += left;
  }
  return mesh;
}

/// A curve that lies off all of its chords: what it changes is the derivative by the radius.
TEST(Chords, AreEstimatedToFirstOrder) {
  for (const Case& one : closed_solutions()) {
    const mesh::Mesh mesh = generated(one.geometry, with_chords(mesh::Preset::uniform, 0.03, 1.25));
    for (const bool outer : {true, false}) {
      const double by = 2e-4 * (outer ? 1 : one.r), R = outer ? 1 + by : 1,
                   r = outer ? one.r : one.r + by;
      const double change = std::abs(one.energy(R, r) - one.energy(1, one.r)),
                   a_change = std::abs(one.a(R, r) - one.a(1, one.r));
      if (change == 0 || (!outer && !one.load.traction.empty())) continue;
      const contact::Answer answer =
          solve_bounded(*factorise(with_larger(mesh, outer, by)), one.load);
      const auto expect = [&](double gap, double exact) {
        std::printf("[ figures  ] %s, %s circle: %.4f of the change\n", one.name,
                    outer ? "outer" : "inner", gap / exact);
        EXPECT_GT(gap, 0.95 * exact);
        EXPECT_LT(gap, 1.25 * exact);
      };
      expect(answer.energy_geometry_error.value(), change);
      if (a_change > 0) expect(answer.inclusions[0].displacement_geometry_error.value(), a_change);
    }
  }
}

/// A membrane with a curve that has tips.
struct Arc {
  const char* name;
  mesh::Geometry geometry;
  fem::Load load;
  bool rigid;
};

std::vector<Arc> arcs() {
  const std::vector<mesh::Point> points{{-0.5, 0}, {0, 0.3}, {0.5, 0}};
  std::vector<Arc> cases;
  Arc arc{"arc", {}, pushed(1), true};
  arc.geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  arc.geometry.inclusions = {on_arc("bow", points)};
  arc.geometry.inclusions[0].stretches = {{0, 1}};
  cases.push_back(arc);
  arc.name = "bonded arc";
  arc.geometry.inclusions[0].stretches.clear();
  arc.load.inclusion_forces = {{"bow", 1}};
  cases.push_back(arc);
  Arc crack{"free crack", {}, pushed(0, "y"), false};
  crack.geometry.boundary = arc.geometry.boundary;
  mesh::CrackSpec bent{"crack", {}, false};
  bent.line = mesh::LineSpec{Shape::arc, points};
  crack.geometry.cracks = {bent};
  cases.push_back(crack);
  crack.name = "crack";
  crack.geometry.cracks[0].contact = true;
  crack.load.boundary_value = "y + x";
  cases.push_back(crack);
  return cases;
}

TEST(Chords, AreEstimatedOnArcs) {
  for (const Arc& one : arcs()) {
    const auto solved = [&](double angle) {
      return on_chords(one.geometry, one.load, with_chords(mesh::Preset::graded, 0.1, angle), 2);
    };
    const Values values = solved(10), finer = solved(2.5);
    expect_estimate(std::string(one.name) + ": energy", values.energy - finer.energy,
                    values.energy_gap);
    if (one.rigid) expect_estimate(std::string(one.name) + ": A", values.a - finer.a, values.a_gap);
  }
}

}  // namespace
}  // namespace anticrack::accuracy
