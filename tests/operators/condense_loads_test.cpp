// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/condense_loads.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "stop/stop.hpp"
#include "support/errors.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::structured_mesh;
using anticrack::testing::StructuredOptions;
using anticrack::testing::throws;
using errors::Reason;

/// The square with an inclusion on (-0.5, 0.5) of y = 0, of which (0, 0.5) is bonded, and a crack
/// on (0.5, 0.75); its right side is free.
using ::testing::ElementsAre;
using ::testing::HasSubstr;

mesh::Mesh membrane() {
  StructuredOptions options;
  options.columns = 16;
  options.kind = [](double x) {
    if (std::abs(x) < 0.5) {
      return x < 0 ? mesh::Kind::delaminated : mesh::Kind::inclusion;
    }
    return x > 0.5 && x < 0.75 ? mesh::Kind::crack : mesh::Kind::glue;
  };
  mesh::Mesh mesh = structured_mesh(options);
  std::erase_if(mesh.dirichlet, [&](const std::array<std::int32_t, 2>& edge) {
    return mesh.xy[2 * static_cast<std::size_t>(edge[0])] == 1 &&
           mesh.xy[2 * static_cast<std::size_t>(edge[1])] == 1;
  });
  return mesh;
}

class CondenseLoad : public ::testing::Test {
 protected:
  CondenseLoad() {
    operators.reserve(decomposition.subdomains.size());
    for (const ddm::Subdomain& subdomain : decomposition.subdomains) {
      operators.emplace_back(subdomain);
    }
  }
  LoadOnTraces condense(const fem::Load& load) const {
    const fem::Load* const one[] = {&load};
    CondensedOutcome outcome =
        std::move(condense_loads(
                      one, mesh, decomposition,
                      [this](std::size_t s, const auto& of_nodes, const auto& dirichlet) {
                        return operators[s].condense(of_nodes, dirichlet);
                      },
                      neumann)
                      .front());
    if (const auto* error = std::get_if<errors::Error>(&outcome)) {
      throw errors::Error(*error);
    }
    return std::get<LoadOnTraces>(std::move(outcome));
  }
  double placed_sum(const PlacedForces& placed) const {
    double sum = 0;
    for (const std::vector<NodalForce>& of_subdomain : placed.subdomains) {
      for (const NodalForce& force : of_subdomain) {
        sum += force.value;
      }
    }
    return sum;
  }
  PlacedForces place(double x, double y) const {
    fem::Load load;
    load.point_forces = {{x, y, 3.0}};
    return place_forces(load, mesh, decomposition);
  }

  mesh::Mesh mesh = membrane();
  ddm::Decomposition decomposition = ddm::cut(mesh);
  ddm::NeumannBoundary neumann{mesh, decomposition};
  std::vector<ddm::SubdomainOperator> operators;
};

/// Largest difference of the condensed loads.
double relative_difference(const LoadOnTraces& a, const LoadOnTraces& b) {
  double greatest = 0;
  for (std::size_t s = 0; s < a.subdomains.size(); ++s) {
    greatest = std::max(greatest, (a.subdomains[s].g - b.subdomains[s].g).cwiseAbs().maxCoeff());
    greatest = std::max(
        greatest, (a.subdomains[s].z_interior - b.subdomains[s].z_interior).cwiseAbs().maxCoeff());
  }
  return greatest;
}

fem::Load of_force(fem::Force force) {
  fem::Load load;
  load.force = std::move(force);
  return load;
}

TEST_F(CondenseLoad, TakesTheSameForceInEveryForm) {
  const LoadOnTraces expected = condense(of_force(fem::Expression{"y > 0 ? 2 : -1"}));
  EXPECT_LT(relative_difference(
                expected, condense(of_force(fem::PerRegion{{{"lower", -1.0}, {"upper", 2.0}}}))),
            1e-14);
  std::vector<double> values(mesh.triangle_count());
  for (std::size_t t = 0; t < values.size(); ++t) {
    values[t] = mesh.subdomain[t] == 0 ? -1 : 2;
  }
  EXPECT_LT(relative_difference(
                expected, condense(of_force(fem::Array{
                              "sha", true, std::make_shared<const std::vector<double>>(values)}))),
            1e-14);
  EXPECT_TRUE(expected.warnings.empty());
  EXPECT_EQ(expected.inclusion_forces.at(0).on_nodes.force, 0.0);
}

TEST_F(CondenseLoad, TakesNodalValuesInTheOrderOfTheMesh) {
  std::vector<double> values(mesh.node_count());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 3 * mesh.xy[2 * i] + mesh.xy[2 * i + 1];
  }
  EXPECT_LT(
      relative_difference(condense(of_force(fem::Expression{"3*x + y"})),
                          condense(of_force(fem::Array{
                              "sha", false, std::make_shared<const std::vector<double>>(values)}))),
      1e-14);
}

TEST_F(CondenseLoad, PutsTractionOnTheNeumannBoundaryOnly) {
  fem::Load load;
  load.traction = "x > 0.99 ? 5 : 1e6";
  const LoadOnTraces pulled = condense(load);
  load.traction = "5";
  EXPECT_LT(relative_difference(pulled, condense(load)), 1e-12);
  EXPECT_GT(relative_difference(pulled, condense(fem::Load{})), 0.1);
}

TEST_F(CondenseLoad, PutsAForceOnAnInclusionIntoOneOfItsTraceNodes) {
  fem::Load load;
  load.inclusion_forces = {{"stiffener", 7.0}};
  const LoadOnTraces pushed = condense(load);
  EXPECT_EQ(pushed.inclusion_forces.at(0).on_nodes.force, 7.0);
  double sum = 0;
  for (std::size_t s = 0; s < operators.size(); ++s) {
    const std::vector<std::int32_t>& rigid = decomposition.subdomains[s].rigid;
    for (std::size_t i = 0; i < rigid.size(); ++i) {
      const double g = pushed.subdomains[s].g[static_cast<Eigen::Index>(i)];
      EXPECT_TRUE(std::abs(g) < 1e-13 || rigid[i] == 0);
      sum += g;
    }
  }
  EXPECT_NEAR(sum, 7.0, 1e-13);
}

TEST_F(CondenseLoad, LetsAPointForceOnAnInclusionActOnIt) {
  for (const double x : {-0.5, -0.3, 0.0, 0.31, 0.5}) {  // delaminated, bonded, tips
    const PlacedForces placed = place(x, 0);
    EXPECT_EQ(placed.inclusions.at(0).on_nodes.force, 3.0) << x;
    EXPECT_EQ(placed_sum(placed), 3.0);
  }
  EXPECT_EQ(place(-0.3, 1e-8).inclusions.at(0).on_nodes.force, 0);
}

TEST_F(CondenseLoad, SpreadsForcesAndMomentsOverAnInclusionThatTilts) {
  mesh.motions = {{true, {}}};
  decomposition = ddm::cut(mesh);
  fem::Load load;
  load.inclusion_forces = {{"stiffener", 7.0}};
  load.inclusion_moments = {{"stiffener", {0.5, 99.0}}};  // y does no work on a line along x
  load.point_forces = {{0.25, 0, 2.0}};
  const PlacedForces placed = place_forces(load, mesh, decomposition);
  const contact::RigidForce& there = placed.inclusions.at(0).on_nodes;
  EXPECT_NEAR(there.force, 9, 1e-13);
  EXPECT_NEAR(there.moment_x, 0.5 + 2 * 0.25, 1e-13);
  EXPECT_NEAR(there.moment_y, 0, 1e-13);
  EXPECT_NEAR(placed_sum(placed), 9, 1e-13);
}

TEST_F(CondenseLoad, ForcesOnAHeldInclusionActOnItsHolders) {
  mesh.motions = {{false, 0.25}};
  decomposition = ddm::cut(mesh);
  fem::Load load;
  load.inclusion_forces = {{"stiffener", 7.0}};
  const PlacedForces placed = place_forces(load, mesh, decomposition);
  EXPECT_EQ(placed.inclusions.at(0).on_nodes.force, 0);
  EXPECT_EQ(placed.inclusions.at(0).on_holders.force, 7);
  EXPECT_EQ(placed_sum(placed), 0);
  EXPECT_THAT(placed.warnings,
              ElementsAre("inclusion_forces[stiffener] moves nothing: the inclusion \"stiffener\" "
                          "is held"));
}

TEST_F(CondenseLoad, WarnsOfWhatMovesNothing) {
  fem::Load load;
  load.point_forces = {{0.3, -0.7, 1.0}, {-1, 0.3, 1.0}, {-0.2, 0, 1.0}};
  const std::string on_boundary =
      "point_forces[1] moves nothing: it acts where the boundary is held";
  EXPECT_THAT(place_forces(load, mesh, decomposition).warnings, ElementsAre(on_boundary));
  EXPECT_THAT(condense(load).warnings, ElementsAre(on_boundary));
  mesh.motions = {{true, {}}};
  decomposition = ddm::cut(mesh);
  load.inclusion_moments = {{"stiffener", {0, 1}}};  // across a line along x
  EXPECT_THAT(place_forces(load, mesh, decomposition).warnings,
              ElementsAre(HasSubstr("inclusion_moments[stiffener] moves nothing: the inclusion "
                                    "\"stiffener\" does not turn that way"),
                          on_boundary));
  mesh.motions = {{false, 0.25}};
  decomposition = ddm::cut(mesh);
  load.inclusion_moments.clear();
  load.point_forces.assign(23, {-0.2, 0, 1.0});
  const std::vector<std::string> many = place_forces(load, mesh, decomposition).warnings;
  ASSERT_EQ(many.size(), 21U);
  EXPECT_EQ(many.back(), "and 3 more forces that move nothing");
}

TEST_F(CondenseLoad, RefusesABoundaryValueThatNothingTakes) {
  mesh.dirichlet.clear();
  mesh.motions = {{false, 0.25}};
  decomposition = ddm::cut(mesh);
  operators.clear();
  for (const ddm::Subdomain& subdomain : decomposition.subdomains)
    operators.emplace_back(subdomain);
  fem::Load load;
  load.boundary_value = "0";
  EXPECT_NO_THROW(condense(load));
  load.boundary_value = "x";
  const auto error = error_of([&] { condense(load); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->fields().at(0).field, "boundary_value");
}

TEST_F(CondenseLoad, RefusesAMomentOnWhatDoesNotTilt) {
  fem::Load load;
  load.inclusion_moments = {{"stiffener", {1, 0}}};
  const auto error = error_of([&] { condense(load); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->fields().at(0).field, "inclusion_moments[stiffener]");
  EXPECT_NE(std::string(error->what()).find("does not tilt; let it tilt"), std::string::npos);
}

TEST_F(CondenseLoad, SharesAPointForceAmongTheCornersAroundIt) {
  const std::vector<std::array<double, 2>> points{
      {0.33, -0.71}, {-0.8, 0.0}, {1, 0.4}, {0.6, 1e-6}, {-1, -1}};
  for (const std::array<double, 2>& at : points) {
    const PlacedForces placed = place(at[0], at[1]);
    EXPECT_EQ(placed.inclusions.at(0).on_nodes.force, 0.0);
    double force = 0, x = 0, y = 0;
    for (std::size_t s = 0; s < placed.subdomains.size(); ++s) {
      for (const NodalForce& nodal : placed.subdomains[s]) {
        const auto node = static_cast<std::size_t>(nodal.node);
        force += nodal.value;
        x += nodal.value * decomposition.subdomains[s].part.xy[2 * node];
        y += nodal.value * decomposition.subdomains[s].part.xy[2 * node + 1];
      }
    }
    EXPECT_NEAR(force, 3, 1e-14);
    EXPECT_NEAR(x, 3 * at[0], 1e-13);
    EXPECT_NEAR(y, 3 * at[1], 1e-13);
  }
}

TEST_F(CondenseLoad, KeepsTheSideOfACrackThatWasMeant) {
  const PlacedForces above = place(0.6, 1e-6), below = place(0.6, -1e-6);
  EXPECT_TRUE(above.subdomains[0].empty());
  EXPECT_EQ(above.subdomains[1].size(), 3U);
  EXPECT_EQ(below.subdomains[0].size(), 3U);
  EXPECT_TRUE(below.subdomains[1].empty());
}

TEST_F(CondenseLoad, RefusesPointsThatAreNowhereOrOnACrack) {
  fem::Load load;
  load.point_forces = {{0, 0.5, 1}, {1.5, 0.25, 1}};
  const auto outside = error_of([&] { condense(load); });
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->fields().at(0).field, "point_forces[1].at");
  EXPECT_NE(std::string(outside->what()).find("(1.5, 0.25) is outside"), std::string::npos);
  load.point_forces = {{0.625, 0, 1}};
  const auto on_crack = error_of([&] { condense(load); });
  ASSERT_TRUE(on_crack);
  EXPECT_EQ(on_crack->fields().at(0).field, "point_forces[0].at");
  EXPECT_NE(std::string(on_crack->what()).find("\"sigma\""), std::string::npos);
}

TEST_F(CondenseLoad, RefusesWhatTheMeshDoesNotHave) {
  EXPECT_TRUE(throws(
      [&] {
        condense(of_force(fem::PerRegion{{{"left", 1.0}}}));
      },
      Reason::invalid_argument, "force.per_region[left]"));
  fem::Load load;
  load.inclusion_forces = {{"fibre", 1.0}};
  const auto error = error_of([&] { condense(load); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->fields().at(0).field, "inclusion_forces[fibre]");
  EXPECT_NE(std::string(error->what()).find("\"stiffener\""), std::string::npos);
  for (const bool per_triangle : {false, true}) {
    const auto wrong = error_of([&] {
      condense(of_force(
          fem::Array{"sha", per_triangle, std::make_shared<const std::vector<double>>(12, 1.0)}));
    });
    ASSERT_TRUE(wrong);
    EXPECT_EQ(wrong->fields().at(0).field, "force.array");
    const std::size_t wanted = per_triangle ? mesh.triangle_count() : mesh.node_count();
    EXPECT_NE(std::string(wrong->what()).find(std::to_string(wanted)), std::string::npos);
  }
}

TEST_F(CondenseLoad, RefusesALoadThatOverflows) {
  const fem::Array huge{"sha", false,
                        std::make_shared<const std::vector<double>>(mesh.node_count(), 1.7e308)};
  EXPECT_TRUE(throws([&] { condense(of_force(huge)); }, Reason::invalid_argument));
}

TEST_F(CondenseLoad, WarnsWhereALimitWasMetAndStopsWhenAsked) {
  const fem::Load rough = of_force(fem::Expression{"y > 0 ? 1 : sin(1e5*x*y)/sqrt(abs(x - 0.03))"});
  const LoadOnTraces loads = condense(rough);
  ASSERT_EQ(loads.warnings.size(), 1U);
  EXPECT_NE(loads.warnings[0].find("\"lower\""), std::string::npos);
  std::stop_source stop;
  stop.request_stop();
  const stop::Scope scope(stop.get_token());
  EXPECT_TRUE(throws([&] { condense(rough); }, Reason::cancelled));
}

}  // namespace
}  // namespace anticrack::operators
