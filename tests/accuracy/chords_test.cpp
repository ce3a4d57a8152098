// SPDX-License-Identifier: GPL-3.0-or-later
//
// Curves and their chords: what chords change of energies and displacements, and its estimate,
// against closed solutions of discs and annuli, and of arcs against a quarter of the angle.
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

struct Values {
  double energy = 0, a = 0;              ///< of the membrane with chords
  double energy_gap = 0, a_gap = 0;      ///< estimates
  double coarse_energy_gap = 0, coarse_a_gap = 0;  ///< on the coarsest mesh
};

/// The mesh's values and those of the mesh twice as fine, of which the errors of h^2 are taken off.
Values on_chords(const mesh::Geometry& geometry, const fem::Load& load, double angle, double size,
                 mesh::Preset preset = mesh::Preset::uniform, int halvings = 2) {
  mesh::MeshOptions options{preset, size};
  options.chord_angle = angle;
  mesh::Mesh mesh = generated(geometry, options);
  Values values;
  double energy = 0, a = 0;
  for (int level = 0; level <= halvings; ++level) {
    if (level > 0) mesh = mesh::refine_uniform(mesh);
    const auto op = factorise(mesh);
    const contact::Answer answer = solve_bounded(*op, load);
    const double found = answer.energy_mesh,
                 moved = answer.inclusions.empty() ? 0 : answer.inclusions[0].displacement_mesh;
    values.energy = (4 * found - energy) / 3;
    values.a = (4 * moved - a) / 3;
    energy = found;
    a = moved;
    values.energy_gap = answer.energy_geometry_error.value_or(NAN);
    if (!answer.inclusions.empty())
      values.a_gap = answer.inclusions[0].displacement_geometry_error.value_or(NAN);
    if (level > 0) continue;
    values.coarse_energy_gap = values.energy_gap;
    values.coarse_a_gap = values.a_gap;
  }
  return values;
}

fem::Load pushed(double f, const std::string& boundary = "") {
  fem::Load load;
  load.force = f;
  load.boundary_value = boundary;
  return load;
}

struct Case {
  const char* name;
  mesh::Geometry geometry;
  fem::Load load;
  double energy, a;
  double size = 0.04;
};

std::vector<Case> closed_solutions() {
  std::vector<Case> cases;
  cases.push_back({"disc", disc(), pushed(1), -pi / 16, 0});
  cases.push_back({"ring", ring(0.25), pushed(0, "log(sqrt(x^2 + y^2))"), pi * std::log(4), 0});
  Case pulled{"pulled", ring(0.25), pushed(0), -pi / 16 * std::log(4), 0};
  pulled.geometry.neumann_sides = {"hole"};
  pulled.load.traction = "1";
  cases.push_back(pulled);
  const double r = 0.5, s = r * r, t = 3;
  Case core{"core", disc(), pushed(1), 0, 0};
  core.geometry.regions = {{"core", {}, t, OutlineSpec{Shape::circle, {{0, 0}}, r}}};
  core.energy = -pi / 2 * ((1 - s) * (1 - s) / 8 + s * (1 - s) / 4 + s * s / (8 * t));
  cases.push_back(core);
  core.name = "drawn core";
  core.load = pushed(0, "x");
  const double inside = 2 / (1 + t + s * (1 - t));
  core.energy = pi / 2 * inside * ((1 + t) / 2 - s * (1 - t) / 2);
  cases.push_back(core);
  Case stiff{"stiff ring", stiff_ring(r, false), pushed(0), 0, std::log(1 / r) / (2 * pi)};
  stiff.load.inclusion_forces = {{"lower", 1}};
  stiff.energy = -0.5 * stiff.a;
  cases.push_back(stiff);
  Case tilted{"tilted ring", stiff_ring(r, true), pushed(0), -(1 - s) / (4 * pi * s), 0};
  tilted.load.inclusion_moments = {{"lower", {1, 0}}};
  cases.push_back(tilted);
  return cases;
}

void tell(const char* name, double angle, const char* what, double value, double off, double gap,
          double coarse) {
  std::printf(
      "[ figures  ] %-12s %5.2f degrees: %s off by %9.2e (%.1e), estimate over this %5.2f, on the "
      "coarse mesh %5.2f\n",
      name, angle, what, off, off / std::abs(value), gap / std::abs(off), coarse / std::abs(off));
}

TEST(Chords, AreEstimatedOnDiscsAndRings) {
  for (const Case& one : closed_solutions()) {
    for (const double angle : {10., 5., 2.5, 1.25}) {
      const Values values = on_chords(one.geometry, one.load, angle, one.size);
      const double off = values.energy - one.energy;
      tell(one.name, angle, "energy", one.energy, off, values.energy_gap,
           values.coarse_energy_gap);
      if (one.a != 0)
        tell(one.name, angle, "A", one.a, values.a - one.a, values.a_gap, values.coarse_a_gap);
    }
  }
}

TEST(Chords, AreEstimatedOnArcs) {
  std::vector<Case> cases;
  Case straight{"straight", disc(), pushed(1), 0, 1};
  straight.geometry.inclusions = {
      {"bar", {}, {}, {}, mesh::LineSpec{Shape::segment, {{0.1, 0.1}}, 20, 1}, {{0, 1}}}};
  cases.push_back(straight);
  Case arc{"arc", {}, pushed(1), 0, 1};
  arc.geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  arc.geometry.inclusions = {on_arc("bow", {{-0.5, 0}, {0, 0.3}, {0.5, 0}})};
  arc.geometry.inclusions[0].stretches = {{0, 1}};
  cases.push_back(arc);
  arc.name = "bonded arc";
  arc.geometry.inclusions[0].stretches.clear();
  arc.load.inclusion_forces = {{"bow", 1}};
  cases.push_back(arc);
  Case crack{"free crack", {}, pushed(0, "y"), 0, 0};
  crack.geometry.boundary = arc.geometry.boundary;
  mesh::CrackSpec bent{"crack", {}, false};
  bent.line = mesh::LineSpec{Shape::arc, {{-0.5, 0}, {0, 0.3}, {0.5, 0}}};
  crack.geometry.cracks = {bent};
  cases.push_back(crack);
  crack.name = "crack";
  crack.geometry.cracks[0].contact = true;
  crack.load.boundary_value = "y + x";
  cases.push_back(crack);
  for (const Case& one : cases) {
    for (const double angle : {10., 5., 2.5}) {
      const Values values =
          on_chords(one.geometry, one.load, angle, 0.1, mesh::Preset::graded, 2);
      const Values finer =
          on_chords(one.geometry, one.load, angle / 4, 0.1, mesh::Preset::graded, 2);
      tell(one.name, angle, "energy", values.energy, values.energy - finer.energy,
           values.energy_gap, values.coarse_energy_gap);
      if (one.a != 0)
        tell(one.name, angle, "A", values.a, values.a - finer.a, values.a_gap,
             values.coarse_a_gap);
    }
  }
}

}  // namespace
}  // namespace anticrack::accuracy
