// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rigid lines that tilt, and cracks without contact, against solutions in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "accuracy/base_meshes.hpp"
#include "accuracy/error_norms.hpp"
#include "accuracy/sequence.hpp"
#include "mesh/refine.hpp"
#include "support/grid_mesh.hpp"
#include "support/paths.hpp"

namespace anticrack::accuracy {
namespace {

using mesh::Kind;
using testing::Complex;
using testing::crack_end;

constexpr std::size_t most_triangles = 2'000'000;
constexpr double turn = 37 * std::numbers::pi / 180;

mesh::Mesh tilting(mesh::Mesh mesh) {
  mesh.motions.assign(mesh.inclusions.size(), {true, {}});
  return mesh;
}

/// u = shift + x Bx + y By.
double linear(double x, double y) { return 0.3 + 0.5 * x - 0.7 * y; }
constexpr const char* linear_text = "0.3 + 0.5*x - 0.7*y";

struct Patch {
  const char* name;
  mesh::Mesh mesh;
};

/// An L of four bonded edges in the middle, with a delaminated foot.
mesh::Mesh kinked() {
  testing::GridMesh grid(8, 8, {"all"}, [](int, int) { return 0; });
  grid.mesh.inclusions = {"stiffener"};
  grid.add({{5, 3}, {3, 3}, {3, 6}}, std::vector<Kind>(5, Kind::inclusion), 0);
  return tilting(std::move(grid.mesh));
}

/// Delaminated parts stay closed: the field falls from the minus to the plus side.
std::vector<Patch> patches() {
  std::vector<Patch> result;
  for (const Kind kind : {Kind::inclusion, Kind::delaminated}) {
    for (const double angle : {0.0, turn}) {
      result.push_back({kind == Kind::inclusion ? "bonded" : "delaminated",
                        Placement(angle, 1)(
                            tilting(mesh::grade(diagonals(kind), {0.2, 0.2, 0}, most_triangles)))});
    }
  }
  result.push_back({"kinked", kinked()});
  return result;
}

/// Along the line, as far as it determines the slope.
void expect_patch(const Patch& patch, std::size_t condensed_up_to) {
  const auto op = factorise(patch.mesh, condensed_up_to);
  const contact::Answer answer = solve(*op, 0.0, linear_text, true);
  double field = 0, area = 0;
  for (const contact::Field& part : answer.fields) {
    for (std::size_t i = 0; i < part.nodes.size(); ++i) {
      const mesh::Point p = mesh::position(op->mesh(), part.nodes[i]);
      field = std::max(field, std::abs(part.u[i] - linear(p[0], p[1])));
    }
  }
  for (std::size_t t = 0; t < op->mesh().triangle_count(); ++t) area += mesh::area(op->mesh(), t);
  const contact::TraceGeometry& line = op->trace_geometry().at(0);
  const contact::InclusionAnswer& rigid = answer.inclusions.at(0);
  mesh::Point low{1e9, 1e9}, high{-1e9, -1e9};
  const mesh::Interface& interface = op->mesh().interfaces[0];
  for (std::size_t e = 0; e < interface.kind.size(); ++e) {
    for (const std::size_t i : {e, e + 1}) {
      if (interface.inclusion[e] < 0) continue;
      low = {std::min(low[0], line.x[i]), std::min(low[1], line.y[i])};
      high = {std::max(high[0], line.x[i]), std::max(high[1], line.y[i])};
    }
  }
  mesh::Point slope{0.5, -0.7};
  if (std::string(patch.name) != "kinked") {
    const double x = line.x.back() - line.x.front(), y = line.y.back() - line.y.front();
    const double along = (slope[0] * x + slope[1] * y) / (x * x + y * y);
    slope = {along * x, along * y};
  }
  const double slopes = std::hypot(rigid.slope_x - slope[0], rigid.slope_y - slope[1]);
  const double middle =
      std::abs(rigid.displacement - linear((low[0] + high[0]) / 2, (low[1] + high[1]) / 2));
  const double exact = (0.5 * 0.5 + 0.7 * 0.7) * area / 2;
  const double energy = std::abs(answer.energy - exact) / exact;
  std::printf("[ figures  ] %s, %s: error of u %.1e, A %.1e, B %.1e, energy %.1e, moment %.1e\n",
              patch.name, testing::path_name(condensed_up_to), field, middle, slopes, energy,
              std::hypot(rigid.moment_x, rigid.moment_y));
  EXPECT_LT(field, 1e-12 * std::max(1.0, std::sqrt(area)));
  EXPECT_LT(middle, 1e-12);
  EXPECT_LT(slopes, 1e-12);
  EXPECT_LT(energy, 1e-12);
  EXPECT_LT(std::abs(rigid.resultant), 1e-12);
  EXPECT_LT(std::hypot(rigid.moment_x, rigid.moment_y), 1e-12);
}

TEST(TiltingInclusion, LeavesALinearFieldAsItIs) {
  for (const Patch& patch : patches()) {
    for (const std::size_t condensed_up_to :
         {operators::default_condensed_up_to, std::size_t{0}, std::size_t{1}}) {
      SCOPED_TRACE(patch.name + std::string(", ") + testing::path_name(condensed_up_to));
      expect_patch(patch, condensed_up_to);
    }
  }
}

/// A bonded line on (-c, c) of the x axis, u = A + B x along it. With R = (z^2 - c^2)^{1/2}, which
/// is imaginary on the line,
///
///   u = Re F,  F = A + s z + (B - s) (z - R) + q ln((z + R)/c) + k z R - i g z
///
/// has that value there: s z - i g z is the field the line finds, k z R one that bends it. From the
/// jump of u_y: the force on the line is -2 pi T q, and the moment about its middle, from
/// 2 T (B - s) x / (c^2 - x^2)^{1/2}, is M = pi T c^2 (B - s). So a line that tilts has
/// B = s + M / (pi T c^2), and a line without moment leaves s z alone; one that keeps its
/// direction, B = 0, has s R and the moment -pi T c^2 s.
struct RigidLine {
  double a = 0.25, s = 0.5, b = 0.5, q = 0, k = 0, g = 0;

  static Complex root(Complex z) { return std::sqrt(z - crack_end) * std::sqrt(z + crack_end); }
  Complex value(Complex z) const {
    const Complex r = root(z);
    return a + s * z + (b - s) * (z - r) + q * std::log((z + r) / crack_end) + k * z * r -
           Complex(0, g) * z;
  }
  Complex derivative(Complex z) const {
    const Complex r = root(z);
    return s + (b - s) * (1.0 - z / r) + q / r + k * (r + z * z / r) - Complex(0, g);
  }
  double force() const { return -2 * std::numbers::pi * q; }
  double moment() const { return std::numbers::pi * crack_end * crack_end * (b - s); }

  std::string boundary() const {
    const auto n = [](double value) { return "(" + std::to_string(value) + ")"; };
    const std::string size = "sqrt(sqrt(((x-0.5)^2 + y^2) * ((x+0.5)^2 + y^2)))",
                      angle = "(0.5*(atan2(y, x-0.5) + atan2(y, x+0.5)))",
                      re = "(" + size + "*cos(" + angle + "))",
                      im = "(" + size + "*sin(" + angle + "))";
    return n(a) + " + " + n(s) + "*x + " + n(g) + "*y + " + n(b - s) + "*(x - " + re + ") + " +
           n(q) + "*0.5*ln(4*((x + " + re + ")^2 + (y + " + im + ")^2)) + " + n(k) + "*(x*" + re +
           " - y*" + im + ")";
  }

  /// int |grad u|^2 / 2 over (-1,1)^2 is half of int u du/dn around it and the line's share, less
  /// the work of the force and the moment: both from Gauss points on pieces of the four sides.
  double energy() const {
    constexpr std::array<double, 3> point{-0.7745966692414834, 0, 0.7745966692414834};
    constexpr std::array<double, 3> weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
    constexpr int pieces = 400;
    double around = 0;
    for (int side = 0; side < 4; ++side) {
      const Complex normal = std::polar(1.0, side * std::numbers::pi / 2);
      for (int piece = 0; piece < pieces; ++piece) {
        for (std::size_t i = 0; i < point.size(); ++i) {
          const Complex z = normal * Complex(1, -1 + (2 * piece + 1 + point[i]) / pieces);
          around += weight[i] / pieces * value(z).real() * (derivative(z) * normal).real();
        }
      }
    }
    return (around - force() * a - moment() * b) / 2;
  }
};

struct LineErrors {
  double a = 0, b = 0, moment = 0, pi = 0, norm = 0;
};

LineErrors measure(const RigidLine& line, bool tilts, double h0, std::size_t condensed_up_to) {
  mesh::Mesh base = mesh::grade(diagonals(Kind::inclusion), {h0, 0.2, 0}, most_triangles);
  const auto op = factorise(tilts ? tilting(std::move(base)) : std::move(base), condensed_up_to);
  fem::Load load;
  load.name = "case";
  load.boundary_value = line.boundary();
  load.inclusion_forces = {{"stiffener", line.force()}};
  if (tilts) load.inclusion_moments = {{"stiffener", {line.moment(), 0}}};
  const contact::Answer answer = solve(*op, load, true);
  const contact::InclusionAnswer& rigid = answer.inclusions.at(0);
  EXPECT_NEAR(rigid.resultant, line.force(), 1e-11);
  EXPECT_EQ(rigid.slope_y, 0);
  const testing::ExactSolution exact{
      "", [&line](Complex z) { return line.derivative(z); }, {}, line.a};
  return {std::abs(rigid.displacement - line.a), std::abs(rigid.slope_x - line.b),
          std::abs(rigid.moment_x - line.moment()), std::abs(answer.energy - line.energy()),
          energy_error(op->mesh(), answer, exact)};
}

/// u ~ r^{1/2} at the tips, so the default grading gives the rates of smooth solutions.
void expect_rates(const char* name, const RigidLine& line, bool tilts,
                  std::size_t condensed_up_to) {
  LineErrors coarse;
  for (const double h0 : {0.4, 0.2, 0.1, 0.05}) {
    const LineErrors fine = measure(line, tilts, h0, condensed_up_to);
    std::printf(
        "[ figures  ] %s, h0 = %.2f: error of A %.2e (%.2f), B %.2e (%.2f), moment %.2e (%.2f), "
        "energy %.2e (%.2f), energy norm %.2e (%.2f)\n",
        name, h0, fine.a, rate(coarse.a, fine.a), fine.b, rate(coarse.b, fine.b), fine.moment,
        rate(coarse.moment, fine.moment), fine.pi, rate(coarse.pi, fine.pi), fine.norm,
        rate(coarse.norm, fine.norm));
    if (h0 < 0.15) {
      EXPECT_GT(rate(coarse.a, fine.a), 1.8);
      EXPECT_GT(rate(coarse.norm, fine.norm), 0.9);
      EXPECT_GT(tilts ? rate(coarse.b, fine.b) : rate(coarse.moment, fine.moment), 1.8);
    }
    // What u on the boundary adds and what the force and the moment add have different signs.
    EXPECT_LT(fine.pi, 0.07 * h0 * h0);
    EXPECT_LT(tilts ? fine.moment : fine.b, 1e-11);
    coarse = fine;
  }
}

const RigidLine pulled{0.25, 0.5, -0.75, 0.125, 0.375, 0.625};

TEST(TiltingInclusion, UnderAMomentHasTheRatesOfSmoothSolutions) {
  expect_rates("tilts", pulled, true, operators::default_condensed_up_to);
}

TEST(TiltingInclusion, UnderAMomentHasTheRatesOfSmoothSolutionsJoined) {
  expect_rates("tilts, joined", pulled, true, 0);
}

/// The moment that holds the direction is an answer.
TEST(RigidInclusion, ThatKeepsItsDirectionHasTheRatesOfSmoothSolutions) {
  RigidLine line = pulled;
  line.b = 0;
  expect_rates("keeps its direction", line, false, operators::default_condensed_up_to);
}

/// B = s + M / (pi c^2): doubling M doubles what it adds, to rounding.
TEST(TiltingInclusion, TiltsInProportionToTheMoment) {
  const auto op =
      factorise(tilting(mesh::grade(diagonals(Kind::inclusion), {0.2, 0.2, 0}, most_triangles)));
  const auto slope = [&op](double moment) {
    fem::Load load;
    load.name = "case";
    load.boundary_value = "0.5*x";
    load.inclusion_moments = {{"stiffener", {moment, 0}}};
    return solve(*op, load, false).inclusions.at(0).slope_x;
  };
  EXPECT_NEAR(slope(0), 0.5, 1e-13);
  EXPECT_NEAR(slope(2) - 0.5, 2 * (slope(1) - 0.5), 1e-13);
  EXPECT_NEAR(slope(-1) - 0.5, 0.5 - slope(1), 1e-13);
  // the plate ends at 1, four c away: stiffer than one without end
  EXPECT_LT(slope(1) - 0.5, 1 / (std::numbers::pi * crack_end * crack_end));
}

/// Anti-plane shear, [u] = 2 (tau/T) (a^2 - x^2)^{1/2}, either way.
class FreeCrack : public ::testing::TestWithParam<std::size_t> {};

TEST_P(FreeCrack, HasTheRatesOfSmoothSolutionsAndItsMirrorImage) {
  constexpr double shear = 0.8;
  const auto exact = testing::open_crack(shear);
  double coarse_jump = 0, coarse_norm = 0;
  for (const double h0 : {0.4, 0.2, 0.1, 0.05}) {
    const auto op =
        factorise(mesh::grade(diagonals(Kind::free), {h0, 0.2, 0}, most_triangles), GetParam());
    const contact::Answer there = solve(*op, 0.0, exact.boundary, true);
    const contact::Answer back = solve(*op, 0.0, testing::open_crack(-shear).boundary, true);
    double mirrored = 0;
    for (std::size_t s = 0; s < there.fields.size(); ++s) {
      for (std::size_t i = 0; i < there.fields[s].u.size(); ++i) {
        mirrored = std::max(mirrored, std::abs(there.fields[s].u[i] + back.fields[s].u[i]));
      }
    }
    const contact::Trace &a = there.traces.at(0), &b = back.traces.at(0);
    double pressure = 0;
    for (std::size_t i = 0; i < a.jump.size(); ++i) {
      mirrored = std::max({mirrored, std::abs(a.u_plus[i] + b.u_plus[i]),
                           std::abs(a.u_minus[i] + b.u_minus[i]), std::abs(a.jump[i] + b.jump[i])});
      const double x = op->trace_geometry().at(0).x[i];
      if (std::abs(x) < crack_end) pressure = std::max(pressure, std::abs(a.pressure[i]));
    }
    const double jump = jump_error(op->mesh(), there, exact).l2;
    const double norm = energy_error(op->mesh(), there, exact);
    std::printf(
        "[ figures  ] free crack, h0 = %.2f: jump %.2e (%.2f), energy norm %.2e (%.2f), mirror "
        "image %.1e\n",
        h0, jump, rate(coarse_jump, jump), norm, rate(coarse_norm, norm), mirrored);
    if (h0 < 0.15) {
      EXPECT_GT(rate(coarse_jump, jump), 1.8);
      EXPECT_GT(rate(coarse_norm, norm), 0.9);
    }
    EXPECT_LT(mirrored, 1e-15);
    EXPECT_EQ(there.energy, back.energy);
    EXPECT_EQ(pressure, 0);
    EXPECT_EQ(there.contact_length, 0);
    coarse_jump = jump;
    coarse_norm = norm;
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, FreeCrack,
                         ::testing::Values(operators::default_condensed_up_to, std::size_t{0},
                                           std::size_t{1}),
                         [](const auto& instance) { return testing::path_name(instance.param); });

}  // namespace
}  // namespace anticrack::accuracy
