// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds on random membranes of all kinds: they hold for every finer mesh as for the membrane
// itself, so the answers of a mesh two levels finer lie in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "estimate/solved.hpp"
#include "mesh/edges.hpp"
#include "mesh/refine_uniform.hpp"
#include "operators/mesh_operator.hpp"
#include "reference/random_fibres.hpp"
#include "reference/random_laws.hpp"
#include "reference/random_membrane.hpp"
#include "support/grid_mesh.hpp"
#include "support/random_seed.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

namespace anticrack::estimate {
namespace {

struct Contained {
  int energies = 0, displacements = 0, forces = 0, slopes = 0, by_slope = 0, none = 0, without = 0,
      unsolved = 0;
  double widest = 0;   // half an interval over the error, both of A
  double nearest = 1;  // room left beside the finer answer, over half the interval
};

struct Random {
  fem::Load load;
  std::vector<double> force;
};

template <class Membrane>
Random random_load(Membrane& membrane, const mesh::Mesh& mesh) {
  Random random;
  random.load.name = "random";
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    random.force.push_back(membrane.uniform(-1, 1));
  random.load.boundary_value = std::to_string(membrane.uniform(-1, 1)) + "*x - 0.4*y";
  const std::vector<char> tilts = reference::tilting(mesh);
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    random.load.inclusion_forces[mesh.inclusions[j]] = membrane.uniform(-3, 3);
    if (tilts[j] != 0)
      random.load.inclusion_moments[mesh.inclusions[j]] = {membrane.uniform(-1, 1),
                                                           membrane.uniform(-1, 1)};
  }
  return random;
}

contact::Answer solve(const mesh::Mesh& mesh, const Random& random, std::size_t copies, bool bounds,
                      std::size_t condensed_up_to = operators::default_condensed_up_to) {
  const auto op = operators::MeshOperator::factorise(std::make_shared<const mesh::Mesh>(mesh), 1,
                                                     {}, condensed_up_to);
  std::vector<double> force;
  for (const double one : random.force) force.insert(force.end(), copies, one);
  fem::Load load = random.load;
  load.force = fem::Array{"", true, std::make_shared<const std::vector<double>>(std::move(force))};
  const fem::Load* const one[] = {&load};
  const auto prepared = std::move(op->prepare(one).front());
  if (const auto* error = std::get_if<errors::Error>(&prepared)) throw errors::Error(*error);
  const auto& ready = std::get<operators::PreparedLoad>(prepared);
  testing::Silent silent;
  contact::Answer answer = testing::solve(*op, ready, contact::ActiveSetOptions{}, true, silent);
  op->find_boundary(ready, answer);
  if (bounds) op->estimate(ready, answer);
  return answer;
}

bool check_interval(const std::optional<double>& lower, const std::optional<double>& upper,
                    double coarse, double fine, const char* what, Contained& tally) {
  EXPECT_EQ(lower.has_value(), upper.has_value());
  if (!lower || !upper) return false;
  const double half = 0.5 * (*upper - *lower), rounding = 1e-11 * (1 + std::abs(fine));
  EXPECT_GT(fine, *lower - rounding) << what;
  EXPECT_LT(fine, *upper + rounding) << what;
  if (half > 1e-9) {
    tally.nearest = std::min(tally.nearest, std::min(fine - *lower, *upper - fine) / half);
    if (std::abs(fine - coarse) > 1e-9)
      tally.widest = std::max(tally.widest, half / std::abs(fine - coarse));
  }
  return true;
}

struct Variant {
  const char* name;
  bool rich = false;
  bool kinked = false;  // boundary values are not linear along all edges
  std::size_t condensed_up_to = operators::default_condensed_up_to;
  bool laws = false;   // of the tension
  double decades = 0;  // of the tension
};

/// Names the stretches of the boundary where u is given, which do not touch each other.
void name_stretches(mesh::Mesh& mesh) {
  std::set<std::pair<std::int32_t, std::int32_t>> held;
  for (const auto& [a, b] : mesh.dirichlet) held.emplace(std::min(a, b), std::max(a, b));
  std::map<std::int32_t, std::int32_t> next;
  std::set<std::int32_t> seconds;
  mesh::EdgeTable(mesh.triangles).each([&](std::span<const mesh::EdgeUse> uses) {
    if (uses.size() != 1 || !held.contains({uses[0].low(), uses[0].high()})) return;
    next[uses[0].from] = uses[0].to;
    seconds.insert(uses[0].to);
  });
  for (auto& [a, b] : mesh.dirichlet)  // the membrane on their left
    if (const auto on = next.find(a); on == next.end() || on->second != b) std::swap(a, b);
  for (const auto& [first, second] : next) {
    if (seconds.contains(first)) continue;
    std::int32_t last = second;
    while (next.contains(last)) last = next[last];
    mesh.boundary_parts.push_back({"stretch " + std::to_string(first), first, last});
  }
}

template <class Membrane>
void check_bounds(Membrane membrane, const Variant& variant, Contained& tally) {
  mesh::Mesh mesh = membrane.mesh();
  if constexpr (std::is_same_v<Membrane, reference::RandomMembrane>)
    if (variant.laws) reference::add_laws(membrane, true, mesh);
  add_contrast(membrane, variant.decades, mesh);
  name_stretches(mesh);
  const mesh::Mesh finer = mesh::refine_uniform(mesh::refine_uniform(mesh));
  Random random = random_load(membrane, mesh);
  if (variant.kinked) random.load.boundary_value += kink(mesh);
  contact::Answer coarse, fine;
  try {
    coarse = solve(mesh, random, 1, true, variant.condensed_up_to);
    fine = solve(finer, random, 16, false);
  } catch (const errors::Error&) {  // nothing holds a part, or no solution
    ++tally.unsolved;
    return;
  }
  if (coarse.status != contact::Status::converged || fine.status != contact::Status::converged) {
    ++tally.unsolved;
    return;
  }
  if (!coarse.no_bracket.empty()) {
    ++tally.without;
    return;
  }
  ++tally.energies;
  const double scale = 1e-11 * (std::abs(coarse.energy) + std::abs(fine.energy) + 1);
  EXPECT_GT(fine.energy, *coarse.energy_lower - scale);
  EXPECT_LT(fine.energy, *coarse.energy_upper + scale);
  for (std::size_t j = 0; j < coarse.inclusions.size(); ++j) {
    const contact::InclusionAnswer &one = coarse.inclusions[j], &better = fine.inclusions[j];
    const bool found = check_interval(one.displacement_lower, one.displacement_upper,
                                      one.displacement_mesh, better.displacement_mesh, "A", tally);
    tally.displacements += found;
    tally.by_slope += found && !one.displacement_estimated_error;
    tally.none += !found;
    tally.slopes += check_interval(one.slope_x_lower, one.slope_x_upper, one.slope_x_mesh,
                                   better.slope_x_mesh, "Bx", tally);
    tally.slopes += check_interval(one.slope_y_lower, one.slope_y_upper, one.slope_y_mesh,
                                   better.slope_y_mesh, "By", tally);
  }
  for (const contact::BoundaryAnswer& one : coarse.boundary)
    for (const contact::BoundaryAnswer& better : fine.boundary)
      if (one.name == better.name && one.free == better.free)
        tally.forces += check_interval(one.resultant_lower, one.resultant_upper, one.resultant,
                                       better.resultant, "R", tally);
}

class Bounds : public ::testing::TestWithParam<Variant> {};

TEST_P(Bounds, ContainTheAnswersOfAMeshTwoLevelsFiner) {
  const unsigned first = testing::random_seed();
  const char* seeds = std::getenv("ANTICRACK_SEEDS");
  const unsigned count = seeds != nullptr ? static_cast<unsigned>(std::atoi(seeds)) : 300;
  Contained tally;
  for (unsigned k = 0; k < count; ++k) {
    SCOPED_TRACE("seed " + std::to_string(first + k));
    check_bounds(reference::RandomMembrane(first + k, GetParam().rich), GetParam(), tally);
  }
  std::printf(
      "[ figures  ] seeds from %u: %d energies, %d A (%d by the slope of Pi), %d forces, %d "
      "slopes, %d "
      "inclusions without (held ones included), %d without bounds, %d unsolved; widest %.0f times, "
      "nearest %.2f\n",
      first, tally.energies, tally.displacements, tally.by_slope, tally.forces, tally.slopes,
      tally.none, tally.without, tally.unsolved, tally.widest, tally.nearest);
  EXPECT_GT(tally.energies, static_cast<int>(count) / 2);
  EXPECT_GT(tally.displacements, static_cast<int>(count) / 4);
}

/// Fibres that cross each other and cracks, on either problem; more than 16 have pairs that the
/// mesh keeps.
TEST(Fibres, HaveBoundsThatContainTheAnswersOfAMeshTwoLevelsFiner) {
  Contained tally;
  int many = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const reference::RandomFibres fibres(seed);
    many += fibres.mesh().inclusions.size() > 16 ? 1 : 0;
    check_bounds(fibres,
                 Variant{"Fibres", true, seed % 2 == 0,
                         std::array{std::size_t{0}, std::size_t{1},
                                    operators::default_condensed_up_to}[seed % 3]},
                 tally);
  }
  EXPECT_GT(many, 8);
  std::printf(
      "[ figures  ] %d of many inclusions, %d of few: %d A (%d by the slope of Pi), %d slopes, %d "
      "without, nearest %.2f\n",
      many, 24 - many, tally.displacements, tally.by_slope, tally.slopes, tally.none,
      tally.nearest);
  EXPECT_GT(tally.displacements, 200);
}

/// An inclusion above a line, or on it, and a load on one side of it.
struct Beside {
  const char* name;
  int y;
  mesh::Kind kind;
  bool load_above;
};

/// Half the width of the bounds of A over |A|, T below the line `ratio` times that above.
double width_beside(const Beside& one, double ratio) {
  constexpr int columns = 12, line = 6;
  testing::GridMesh grid(columns, 2 * line, {"below", "above"},
                         [](int, int j) { return j < line ? 0 : 1; });
  grid.mesh.tension = {ratio, 1};
  grid.mesh.inclusions = {"inclusion"};
  std::vector<mesh::Kind> kinds(columns, mesh::Kind::glue);
  if (one.y == line)
    std::fill(kinds.begin() + 4, kinds.begin() + 8, one.kind);
  else
    grid.add({{4, one.y}, {8, one.y}}, std::vector<mesh::Kind>(4, one.kind), 0);
  grid.add({{0, line}, {columns, line}}, kinds, 0);
  const mesh::Mesh finer = mesh::refine_uniform(grid.mesh);
  Random random;
  for (const std::int32_t part : finer.subdomain)
    random.force.push_back((part == 1) == one.load_above ? 1 : 0);
  const contact::Answer coarse = solve(finer, random, 1, true),
                        fine = solve(mesh::refine_uniform(mesh::refine_uniform(finer)), random, 16,
                                     false);
  const contact::InclusionAnswer& of = coarse.inclusions.front();
  const double truth = fine.inclusions.front().displacement_mesh;
  Contained tally;
  EXPECT_TRUE(check_interval(of.displacement_lower, of.displacement_upper, of.displacement_mesh,
                             truth, one.name, tally));
  return (*of.displacement_upper - *of.displacement_lower) / 2 / std::abs(truth);
}

TEST(Contrast, WidensTheBoundsOfAByNoMoreThanAConstant) {
  using enum mesh::Kind;
  for (const Beside& one :
       {Beside{"off the load", 9, inclusion, false}, Beside{"beside the load", 9, inclusion, true},
        Beside{"delaminated, off the load", 9, delaminated, false},
        Beside{"delaminated, beside the load", 9, delaminated, true},
        Beside{"on the line", 6, inclusion, false},
        Beside{"delaminated on the line", 6, delaminated, false},
        Beside{"delaminated on the line, load above", 6, delaminated, true}}) {
    std::vector<double> widths;
    std::string figures;
    for (const double decades : {-8, -6, -4, -2, 0, 2, 4, 6, 8}) {
      widths.push_back(width_beside(one, std::pow(10, decades)));
      figures += fmt::format(" {:.3g}", widths.back());
    }
    std::printf("[ figures  ] %s:%s\n", one.name, figures.c_str());
    // One c for both parts where the minus side of a delaminated inclusion is the stiff one.
    const bool above_only = one.y == 6 && one.kind == delaminated;
    for (const bool below : {false, true}) {
      if (below && above_only) continue;
      const double far = widths[below ? 8 : 0], near = widths[below ? 6 : 2];
      EXPECT_LT(far, 1);
      EXPECT_NEAR(far, near, 0.05 * near);
    }
  }
}

TEST(ManyInclusions, OnVeryManyTrianglesOfALongInterfaceHaveNoneAndAWarning) {
  testing::GridMesh grid(230, 230, {"all"}, [](int, int) { return 0; });
  for (int j = 0; j < 14 * 14; ++j) {
    const testing::GridMesh::Point from = {5 + 16 * (j % 14), 5 + 16 * (j / 14)};
    grid.mesh.inclusions.push_back("fibre " + std::to_string(j));
    grid.add({from, {from[0] + 2, from[1]}}, {2, mesh::Kind::delaminated}, j);
  }
  Random random{{}, std::vector<double>(grid.mesh.triangle_count())};
  random.load.boundary_value = "x";
  const contact::Answer answer = solve(grid.mesh, random, 1, true, 0);
  EXPECT_TRUE(answer.energy_lower);
  EXPECT_FALSE(answer.inclusions.front().displacement_lower);
  EXPECT_THAT(answer.warnings, ::testing::Contains(::testing::StartsWith(
                                   "no bounds of A: 196 inclusions on 105800 triangles, more than "
                                   "20000000 of both multiplied")));
}

/// All bounds of an answer.
std::vector<double> bounds_of(const contact::Answer& answer) {
  std::vector<double> bounds;
  const auto add = [&](const std::optional<double>& one) {
    bounds.push_back(one.value_or(-1e300));
  };
  for (const auto& one :
       {answer.energy_lower, answer.energy_upper, answer.error_bound, answer.error_bound_relative})
    add(one);
  for (const contact::InclusionAnswer& of : answer.inclusions)
    for (const auto& one :
         {of.displacement_lower, of.displacement_upper, of.displacement_estimated_error,
          of.slope_x_lower, of.slope_x_upper, of.slope_y_lower, of.slope_y_upper})
      add(one);
  return bounds;
}

/// Expects that what leaves a triangle is the load on it, and enters its neighbour unless an
/// interface lies between them. `force` (m), `flux` (m,3).
void expect_balance(const mesh::Mesh& mesh, const std::vector<double>& force,
                    const std::vector<double>& flux) {
  double size = 0;
  for (const double one : flux) size = std::max(size, std::abs(one));
  for (std::size_t t = 0; t < force.size(); ++t)
    EXPECT_NEAR(flux[3 * t] + flux[3 * t + 1] + flux[3 * t + 2], -force[t] * mesh::area(mesh, t),
                1e-10 * size);
  std::set<std::pair<std::int32_t, std::int32_t>> cut;
  for (const mesh::Interface& line : mesh.interfaces)
    for (std::size_t k = 0; k < line.kind.size(); ++k)
      if (line.kind[k] != mesh::Kind::glue)
        cut.insert(std::minmax(line.nodes[k], line.nodes[k + 1]));
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<double>> through;
  for (std::size_t side = 0; side < flux.size(); ++side) {
    const std::size_t first = side - side % 3;
    through[std::minmax(mesh.triangles[first + (side + 1) % 3],
                        mesh.triangles[first + (side + 2) % 3])]
        .push_back(flux[side]);
  }
  for (const auto& [edge, two] : through) {
    if (two.size() == 2 && !cut.contains(edge)) {
      EXPECT_NEAR(two[0], -two[1], 1e-10 * size);
    }
  }
}

/// How many of a random membrane have bounds, alone and with others the same.
int compare_alone(unsigned seed, const Variant& variant) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  constexpr std::size_t count = 6;  // not a multiple of what is done at once
  reference::RandomMembrane membrane(seed, variant.rich);
  mesh::Mesh mesh = membrane.mesh();
  if (variant.laws) reference::add_laws(membrane, true, mesh);
  const auto op = operators::MeshOperator::factorise(std::make_shared<const mesh::Mesh>(mesh), 1,
                                                     {}, variant.condensed_up_to);
  std::vector<operators::PreparedLoad> loads;
  std::vector<contact::Answer> alone;
  std::vector<std::vector<double>> forces;
  testing::Silent silent;
  while (loads.size() < count) {
    const Random random = random_load(membrane, mesh);
    fem::Load load = random.load;
    load.force = fem::Array{"", true, std::make_shared<const std::vector<double>>(random.force)};
    forces.push_back(random.force);
    if (loads.size() % 2 == 1) load.boundary_value = "sin(3*x)*y";  // not linear along edges
    const fem::Load* const one[] = {&load};
    const auto prepared = std::move(op->prepare(one).front());
    if (const auto* error = std::get_if<errors::Error>(&prepared)) throw errors::Error(*error);
    loads.push_back(std::get<operators::PreparedLoad>(prepared));
    alone.push_back(testing::solve(*op, loads.back(), contact::ActiveSetOptions{}, true, silent));
  }
  std::vector<contact::Answer> together = alone;
  std::vector<operators::MeshOperator::Estimate> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.push_back({&loads[i], &together[i], {}});
    all.back().keep_flux = true;
  }
  op->estimate(all);
  int bounded = 0;
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_FALSE(all[i].failure);
    EXPECT_EQ(op->estimate(loads[i], alone[i]), all[i].indicator);
    EXPECT_EQ(alone[i].no_bracket, together[i].no_bracket);
    EXPECT_EQ(all[i].balanced_flux.empty(), !alone[i].energy_lower);
    if (!all[i].balanced_flux.empty()) expect_balance(mesh, forces[i], all[i].balanced_flux);
    EXPECT_EQ(bounds_of(alone[i]), bounds_of(together[i]));
    bounded += alone[i].energy_lower ? 1 : 0;
  }
  return bounded;
}

TEST_P(Bounds, HaveTheSameBitsAloneAndWithOthers) {
  int bounded = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    try {
      bounded += compare_alone(seed, GetParam());
    } catch (const errors::Error&) {  // nothing holds a part
    }
  }
  EXPECT_GT(bounded, 60);
}

INSTANTIATE_TEST_SUITE_P(
    Random, Bounds,
    ::testing::Values(Variant{"Plain"}, Variant{"Rich", true}, Variant{"Joined", true, true, 0},
                      Variant{"Contacts", true, false, 1},
                      Variant{"Laws", true, true, operators::default_condensed_up_to, true},
                      Variant{"Contrast", true, false, operators::default_condensed_up_to, false,
                              16}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace anticrack::estimate
