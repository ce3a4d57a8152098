// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers do not depend on which mesh of which kind, on left and right, or on whether the mesh
// follows the jumps of the load, on direction and on units.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/base_meshes.hpp"
#include "accuracy/paper_limits.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"
#include "support/grid_mesh.hpp"
#include "support/multipliers.hpp"
#include "support/paths.hpp"

namespace anticrack::accuracy {
namespace {

mesh::Mesh graded_like_default(const mesh::Mesh& base) {
  return mesh::grade(base, {0.1, 0.2, 0}, 200'000);  // h0, m
}

/// f(-x, y) or f(x, -y).
std::string reflected(std::string text, Mirror mirror) {
  const char variable = mirror == Mirror::x ? 'x' : 'y';
  for (std::size_t i = text.find(variable); i != std::string::npos;
       i = text.find(variable, i + 4)) {
    text.replace(i, 1, std::string("(-") + variable + ")");
  }
  return text;
}

double largest(const std::vector<double>& values) {
  double result = 0;
  for (const double value : values) {
    result = std::max(result, std::abs(value));
  }
  return result;
}

/// Largest difference of the traces, the second walked backwards.
double difference(const contact::Trace& a, const contact::Trace& b) {
  double result = 0;
  for (std::size_t i = 0, j = a.jump.size() - 1; i < a.jump.size(); ++i, --j) {
    result = std::max(
        {result, std::abs(a.u_plus[i] - b.u_plus[j]), std::abs(a.u_minus[i] - b.u_minus[j])});
  }
  return result;
}

class Example : public ::testing::TestWithParam<std::size_t> {
 protected:
  const char* force() const { return paper_forces[GetParam()]; }
};

/// Half a percent of the largest deflection is what h0 = 0.1 leaves of A; see examples_test.
TEST_P(Example, IsTheSameOnOtherBaseMeshes) {
  const double scale = 0.2;
  double lowest = 1, highest = -1;
  const auto look = [&](const char* name, const mesh::Mesh& mesh) {
    const contact::Answer answer = solve(*factorise(mesh), fem::Expression{force()});
    const double a = answer.inclusions.at(0).displacement;
    std::printf("[ figures  ] example %zu, %s, %zu triangles: A %.8f, energy %.8f\n",
                GetParam() + 1, name, mesh.triangle_count(), a, answer.energy);
    EXPECT_NEAR(a, a_limits[GetParam()], 5e-3 * scale);
    EXPECT_NEAR(answer.energy, energy_limits[GetParam()], 8e-3 * std::abs(answer.energy));
    lowest = std::min(lowest, a);
    highest = std::max(highest, a);
  };
  look("diagonals", graded_like_default(diagonals()));
  look("rectangles", graded_like_default(rectangles()));
  look("shaken", graded_like_default(shaken(7)));
  look("generated", generated(0.1));
  EXPECT_LT(highest - lowest, 3e-3 * scale);
}

void expect_mirrored(const mesh::Mesh& mesh, std::size_t example, Mirror mirror, char axis) {
  const char* force = paper_forces[example];
  const contact::Answer original = solve(*factorise(mesh), fem::Expression{force});
  const contact::Answer image =
      solve(*factorise(mirrored(mesh, mirror)), fem::Expression{reflected(force, mirror)});
  const double worst = difference(original.traces.at(0), image.traces.at(0));
  std::printf("[ figures  ] example %zu, %c -> -%c: traces differ by %.1e\n", example + 1, axis,
              axis, worst);
  EXPECT_LT(worst, 1e-10);
  EXPECT_NEAR(original.energy, image.energy, 1e-11);
  EXPECT_NEAR(original.contact_length, image.contact_length, 1e-9);
}

TEST_P(Example, MirrorsLeftAndRight) {
  expect_mirrored(graded_like_default(shaken(11)), GetParam(), Mirror::x, 'x');
}

/// The plus side, Omega_2, is then the lower half.
TEST_P(Example, MirrorsUpAndDown) {
  expect_mirrored(graded_like_default(shaken(12)), GetParam(), Mirror::y, 'y');
}

/// A crack without inclusion does not know its plus side: u -> -u exchanges them.
TEST_P(Example, OfACrackMirrorsUpsideDown) {
  mesh::Mesh mesh = graded_like_default(diagonals(mesh::Kind::crack));
  const contact::Answer original = solve(*factorise(mesh), fem::Expression{force()});
  const contact::Answer image = solve(*factorise(turned(mirrored(mesh, Mirror::y))),
                                      fem::Expression{"-(" + reflected(force(), Mirror::y) + ")"});
  double worst = 0;
  for (std::size_t i = 0; i < original.traces.at(0).jump.size(); ++i) {
    const contact::Trace &a = original.traces[0], &b = image.traces.at(0);
    worst = std::max(
        {worst, std::abs(a.u_plus[i] + b.u_minus[i]), std::abs(a.u_minus[i] + b.u_plus[i])});
  }
  std::printf(
      "[ figures  ] example %zu without inclusion, u -> -u: traces differ by %.1e, largest "
      "jump %.3e\n",
      GetParam() + 1, worst, largest(original.traces[0].jump));
  EXPECT_LT(worst, 1e-10);
  EXPECT_NEAR(original.energy, image.energy, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Paper, Example, ::testing::Range<std::size_t>(0, 4),
                         [](const auto& named) { return std::to_string(named.param + 1); });

/// The value in the middle of each triangle as a constant on it: what not finding the jump costs.
fem::Force middles(const mesh::Mesh& mesh, std::size_t example) {
  const auto at = [&](std::size_t t, std::size_t axis) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += mesh.xy[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k]) + axis];
    }
    return sum / 3;
  };
  auto values = std::make_shared<std::vector<double>>(mesh.triangle_count());
  for (std::size_t t = 0; t < values->size(); ++t) {
    (*values)[t] = at(t, 0) * (example == 1 ? at(t, 1) : -1) < 0 ? -1 : 1;
  }
  fem::Array array;
  array.per_triangle = true;
  array.values = values;
  return array;
}

/// Examples 2 and 4 jump on x = 0. Where edges follow that line the loads are those of constants;
/// where they cross it, the integral has to find it. What is left is the error of the mesh, 6e-5.
TEST(JumpingLoad, NeedsNoMeshThatFollowsIt) {
  for (const std::size_t example : {1U, 3U}) {
    const fem::Force force = fem::Expression{paper_forces[example]};
    const double following =
        solve(*factorise(graded_like_default(diagonals())), force).inclusions.at(0).displacement;
    double moved = 0, moved_carelessly = 0;
    for (const unsigned seed : {1U, 2U, 3U}) {
      const auto op = factorise(graded_like_default(shaken(seed)));
      const double a = solve(*op, force).inclusions.at(0).displacement;
      const double careless =
          solve(*op, middles(op->mesh(), example)).inclusions.at(0).displacement;
      std::printf(
          "[ figures  ] example %zu: A %.8f on a mesh that follows the jump, %.8f on one "
          "that does not (seed %u), there %.8f with the values in the middles\n",
          example + 1, following, a, seed, careless);
      EXPECT_NEAR(a, following, 6e-5);
      moved += std::abs(a - following);
      moved_carelessly += std::abs(careless - following);
    }
    EXPECT_GT(moved_carelessly, 5 * moved);  // else this test could not tell
  }
}

/// Everything at once on a square of 16: crossing cracks, one that ends on the Dirichlet boundary,
/// a free one, a bonded inclusion that tilts and a delaminated one with a kink that does.
mesh::Mesh all_sorts() {
  using mesh::Kind;
  testing::GridMesh grid(16, 16, {"all"}, [](int, int) { return 0; });
  grid.mesh.inclusions = {"straight", "kinked"};
  grid.mesh.motions = {{true, {}}, {true, {}}};
  const auto all = [](std::size_t edges, Kind kind) { return std::vector<Kind>(edges, kind); };
  grid.add({{2, 3}, {8, 3}}, all(6, Kind::crack));
  grid.add({{5, 6}, {5, 1}}, all(5, Kind::crack));
  grid.add({{16, 9}, {11, 9}}, all(5, Kind::crack));
  grid.add({{10, 2}, {10, 7}}, all(5, Kind::free));
  grid.add({{2, 9}, {6, 9}}, all(4, Kind::inclusion), 0);
  grid.add({{3, 14}, {8, 14}, {8, 11}}, all(8, Kind::delaminated), 1);
  for (std::size_t i = 0; i < grid.mesh.xy.size(); ++i) {  // no symmetry, the boundary as well
    grid.mesh.xy[i] += 0.12 * std::sin(1.7 * static_cast<double>(i * i));
  }
  // straight to rounding
  for (int i = 2; i <= 6; ++i) {
    const auto node = static_cast<std::size_t>(grid.node({i, 9}));
    grid.mesh.xy[2 * node] = i;
    grid.mesh.xy[2 * node + 1] = 9 + 0.125 * (i - 4);
  }
  return std::move(grid.mesh);
}

/// A change of units and directions: lengths by `size`, forces and u by `load`.
struct Units {
  double angle, size, load;
};

/// The middle of an inclusion's bounding box, in whose place A is.
mesh::Point middle(const mesh::Mesh& mesh, std::int32_t inclusion) {
  mesh::Point low{1e300, 1e300}, high{-1e300, -1e300};
  for (const mesh::Interface& interface : mesh.interfaces) {
    for (std::size_t e = 0; e < interface.kind.size(); ++e) {
      for (const std::size_t i : {e, e + 1}) {
        if (interface.inclusion[e] != inclusion) continue;
        const mesh::Point p = mesh::position(mesh, interface.nodes[i]);
        low = {std::min(low[0], p[0]), std::min(low[1], p[1])};
        high = {std::max(high[0], p[0]), std::max(high[1], p[1])};
      }
    }
  }
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
}

contact::Answer solve_all_sorts(const Units& units, std::size_t condensed_up_to) {
  const Placement place(units.angle, units.size);
  const auto op = factorise(place(all_sorts()), condensed_up_to);
  const auto text = [](double value) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "(%.17g)", value);
    return std::string(digits);
  };
  const mesh::Point x = place({1, 0});
  const double turn = 1 / units.size / units.size;
  fem::Load load;
  load.name = "case";
  std::vector<double> force;
  for (std::size_t t = 0; t < op->mesh().triangle_count(); ++t) {
    force.push_back(units.load * turn * std::cos(0.37 * static_cast<double>(t)));
  }
  load.force = fem::Array{"", true, std::make_shared<const std::vector<double>>(std::move(force))};
  load.boundary_value = text(units.load * turn * 0.3) + "*(" + text(x[0]) + "*x + " + text(x[1]) +
                        "*y) - " + text(units.load * turn * 0.2) + "*(" + text(x[0]) + "*y - " +
                        text(x[1]) + "*x)";
  const mesh::Point at = place({12.3, 4.2});
  load.point_forces = {{at[0], at[1], 2 * units.load}};
  load.inclusion_forces = {{"straight", 0.5 * units.load}};
  const mesh::Point moment = place({1.5, 0.7});
  load.inclusion_moments = {{"straight", {units.load * moment[0], units.load * moment[1]}}};
  return solve(*op, load, true);
}

/// The answer back in the units and directions of the first.
struct Plain {
  std::vector<double> u, pressure, slope, moment, displacement, resultant;
  double energy, contact_length;

  Plain(const contact::Answer& answer, const Units& units) {
    const Placement back(-units.angle, 1);
    const mesh::Mesh here = Placement(units.angle, units.size)(all_sorts());
    for (const contact::Field& field : answer.fields) add(u, by_node(field), 1 / units.load);
    for (const contact::Trace& trace : answer.traces) {
      add(u, trace.u_plus, 1 / units.load);
      add(u, trace.jump, 1 / units.load);
      add(pressure, testing::multipliers(trace), units.size / units.load);
    }
    for (std::int32_t j = 0; j < 2; ++j) {
      const contact::InclusionAnswer& rigid = answer.inclusions.at(static_cast<std::size_t>(j));
      const mesh::Point b = back({rigid.slope_x, rigid.slope_y});
      const mesh::Point m = back({rigid.moment_x, rigid.moment_y});
      add(slope, {b[0], b[1]}, units.size / units.load);
      if (j == 0) add(moment, {m[0], m[1]}, 1 / units.load / units.size);
      // A of the one with a kink is read in the middle of another box.
      const mesh::Point other = Placement(units.angle, units.size)(middle(all_sorts(), j));
      const mesh::Point own = middle(here, j);
      add(displacement,
          {rigid.displacement + rigid.slope_x * (other[0] - own[0]) +
           rigid.slope_y * (other[1] - own[1])},
          1 / units.load);
      add(resultant, {rigid.resultant}, 1 / units.load);
    }
    energy = answer.energy / units.load / units.load;
    contact_length = answer.contact_length / units.size;
  }

 private:
  /// Nodes are numbered along a curve in the plane.
  static std::vector<double> by_node(const contact::Field& field) {
    std::vector<std::pair<std::int32_t, double>> values;
    for (std::size_t i = 0; i < field.u.size(); ++i)
      values.emplace_back(field.nodes[i], field.u[i]);
    std::ranges::sort(values);
    std::vector<double> result;
    for (const auto& [node, value] : values) result.push_back(value);
    return result;
  }
  static void add(std::vector<double>& to, const std::vector<double>& values, double factor) {
    for (const double value : values) to.push_back(factor * value);
  }
};

double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double result = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    result = std::max(result, std::abs(a[i] - b[i]));
  }
  return result / largest(a);
}

class ChangedUnits : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ChangedUnits, ChangeNothingElse) {
  const contact::Answer wanted = solve_all_sorts({0, 1, 1}, GetParam());
  const Plain plain(wanted, {0, 1, 1});
  EXPECT_GT(plain.contact_length, 2);  // of 28 that can close
  EXPECT_LT(plain.contact_length, 26);
  for (const Units& units :
       {Units{37 * std::numbers::pi / 180, 1, 1}, Units{0, 1e-6, 1}, Units{0, 1e6, 1},
        Units{0, 1, 1e-12}, Units{0, 1, 1e12}, Units{37 * std::numbers::pi / 180, 1e-6, 1e12}}) {
    const contact::Answer answer = solve_all_sorts(units, GetParam());
    const Plain other(answer, units);
    const double u = relative_difference(plain.u, other.u),
                 pressure = relative_difference(plain.pressure, other.pressure),
                 slope = relative_difference(plain.slope, other.slope),
                 moment = relative_difference(plain.moment, other.moment),
                 a = relative_difference(plain.displacement, other.displacement),
                 resultant = relative_difference(plain.resultant, other.resultant),
                 energy = std::abs(plain.energy - other.energy) / std::abs(plain.energy);
    std::printf(
        "[ figures  ] %.0f degrees, lengths by %.0e, loads by %.0e: u %.1e, pressure %.1e, B "
        "%.1e, moment %.1e, A %.1e, resultant %.1e, energy %.1e\n",
        units.angle * 180 / std::numbers::pi, units.size, units.load, u, pressure, slope, moment, a,
        resultant, energy);
    EXPECT_LT(std::max({u, pressure, slope, moment, a, resultant, energy}), 1e-11);
    EXPECT_EQ(answer.closed, wanted.closed);
    EXPECT_EQ(answer.iterations, wanted.iterations);
    EXPECT_NEAR(other.contact_length, plain.contact_length, 1e-11);
    EXPECT_EQ(answer.contact_intervals.size(), wanted.contact_intervals.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, ChangedUnits,
                         ::testing::Values(operators::default_condensed_up_to, std::size_t{0},
                                           std::size_t{1}),
                         [](const auto& instance) { return testing::path_name(instance.param); });

}  // namespace
}  // namespace anticrack::accuracy
