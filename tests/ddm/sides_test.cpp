// SPDX-License-Identifier: GPL-3.0-or-later
//
// Slits, cross points and rings: how many sides a node has, what ties them, what is left.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "ddm/neumann_boundary.hpp"
#include "ddm_support.hpp"
#include "mesh/joined_inclusions.hpp"
#include "support/grid_mesh.hpp"

namespace anticrack::ddm {
namespace {

using errors::Reason;
using mesh::Kind;
using ::testing::ElementsAre;
using testing::expect_refused;
using testing::GridMesh;
using ::testing::HasSubstr;

constexpr Kind g = Kind::glue, c = Kind::crack, b = Kind::inclusion, d = Kind::delaminated;

Decomposition cut_valid(const GridMesh& grid) {
  mesh::validate(grid.mesh);
  return cut(grid.mesh);
}

std::int32_t unknown(const Decomposition& decomposition, std::int32_t subdomain,
                     std::int32_t trace) {
  return decomposition.subdomains.at(static_cast<std::size_t>(subdomain))
      .unknown.at(static_cast<std::size_t>(trace));
}

/// Values of w on the two sides of an interface's node.
std::array<std::int32_t, 2> values(const Decomposition& decomposition, std::size_t interface,
                                   std::size_t node) {
  const SidePair& sides = decomposition.interface_sides.at(interface).at(node);
  return {unknown(decomposition, sides.minus, sides.minus_trace),
          unknown(decomposition, sides.plus, sides.plus_trace)};
}

/// Which of the subdomain's traces a point on the given side of the interface's edge belongs to is
/// told by the triangles: the centroid of one that has the local node as a corner.
bool touches_from(const Subdomain& subdomain, std::int32_t trace, double y, bool above) {
  const auto local = static_cast<std::int32_t>(subdomain.interior) + trace;
  for (std::size_t t = 0; t < subdomain.part.triangle_count(); ++t) {
    double centroid = 0;
    bool has = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t corner = subdomain.part.triangles[3 * t + k];
      has |= corner == local;
      centroid += subdomain.part.xy[2 * static_cast<std::size_t>(corner) + 1] / 3;
    }
    if (has && (centroid > y) != above) {
      return false;
    }
  }
  return true;
}

GridMesh one(int nx, int ny) {
  return {nx, ny, {"membrane"}, [](int, int) { return 0; }};
}

TEST(Slit, HasTwoSidesAndTipsThatHaveOne) {
  GridMesh grid = one(8, 6);
  grid.add({{2, 3}, {6, 3}}, {c, c, c, c});
  const Decomposition result = cut_valid(grid);
  ASSERT_EQ(result.subdomains.size(), 1U);
  const Subdomain& membrane = result.subdomains[0];
  EXPECT_EQ(membrane.trace, 2U + 2 * 3);
  EXPECT_EQ(membrane.interior, 7U * 5 - 5);
  EXPECT_EQ(membrane.node.size(), 9U * 7 + 3);
  EXPECT_EQ(result.pairs.size(), 3U);
  EXPECT_EQ(result.skeleton.unknowns, 8U);
  EXPECT_EQ(result.skeleton.contacts.size(), 3U);
  ASSERT_EQ(result.interface_sides[0].size(), 5U);
  for (const std::size_t tip : {0U, 4U}) {
    const SidePair& sides = result.interface_sides[0][tip];
    EXPECT_EQ(sides.pair, -1);
    EXPECT_EQ(sides.kind, Kind::glue);
    EXPECT_EQ(sides.minus, 0);
    EXPECT_EQ(sides.plus, 0);
    EXPECT_EQ(sides.minus_trace, sides.plus_trace);
    EXPECT_GE(sides.plus_trace, 0);
  }
  for (const std::size_t node : {1U, 2U, 3U}) {
    const SidePair& sides = result.interface_sides[0][node];
    EXPECT_EQ(sides.pair, static_cast<int>(node) - 1);
    EXPECT_EQ(sides.kind, Kind::crack);
    EXPECT_TRUE(touches_from(membrane, sides.plus_trace, 3, true));
    EXPECT_TRUE(touches_from(membrane, sides.minus_trace, 3, false));
    EXPECT_NE(sides.minus_trace, sides.plus_trace);
    EXPECT_EQ(result.pairs[node - 1].contact, static_cast<int>(node) - 1);
  }
  EXPECT_THAT(result.edges[0].node, ElementsAre(-1, 0));
  EXPECT_THAT(result.edges[3].node, ElementsAre(2, -1));
  EXPECT_EQ(uzawa_obstacle(result, grid.mesh), "");
}

TEST(Slit, OfOneEdgeIsClosed) {
  GridMesh grid = one(5, 4);
  const Decomposition result = cut_valid(grid.add({{2, 2}, {3, 2}}, {c}));
  EXPECT_EQ(result.subdomains[0].trace, 2U);
  EXPECT_TRUE(result.pairs.empty());
  EXPECT_TRUE(result.skeleton.contacts.empty());
  EXPECT_EQ(result.skeleton.unknowns, 2U);
}

TEST(Slit, AtTheNeumannBoundaryIsOpenThere) {
  GridMesh grid = one(5, 4);
  grid.release([](double x, double) { return x == 0; }).add({{0, 2}, {3, 2}}, {c, c, c});
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.skeleton.contacts.size(), 3U);
  EXPECT_EQ(result.interface_sides[0][0].kind, Kind::crack);
  const NeumannBoundary neumann(grid.mesh, result);
  EXPECT_EQ(neumann.of(0).nodes.size(), 4U);
  for (const auto& edge : neumann.of(0).nodes) {
    const Subdomain& membrane = result.subdomains[0];
    const std::vector<double>& xy = membrane.part.xy;
    const auto from = static_cast<std::size_t>(edge[0]), to = static_cast<std::size_t>(edge[1]);
    EXPECT_EQ(xy[2 * from], 0);
    EXPECT_EQ(xy[2 * from + 1] - xy[2 * to + 1], 1);  // membrane on the left
  }
}

TEST(Slit, WithAnInclusionHoldsItsPlusSideAndTips) {
  GridMesh grid = one(9, 6);
  grid.mesh.inclusions = {"bar"};
  const Decomposition result = cut_valid(grid.add({{2, 3}, {7, 3}}, {d, d, b, d, d}, 0));
  EXPECT_EQ(result.subdomains[0].trace, 2U + 2 * 4);
  EXPECT_EQ(std::count(result.subdomains[0].rigid.begin(), result.subdomains[0].rigid.end(), 0),
            2 + 4);
  EXPECT_EQ(result.skeleton.contacts.size(), 2U);  // the nodes of the bonded edge are tied
  EXPECT_EQ(result.skeleton.unknowns, 1U + 2);
  std::vector<Kind> kinds;
  kinds.reserve(result.interface_sides[0].size());
  for (const SidePair& sides : result.interface_sides[0]) {
    kinds.push_back(sides.kind);
  }
  EXPECT_THAT(kinds, ElementsAre(b, d, b, b, d, b));
  EXPECT_THAT(values(result, 0, 0), ElementsAre(0, 0));
  EXPECT_THAT(values(result, 0, 1), ElementsAre(::testing::Gt(0), 0));
}

TEST(Slit, ThatContinuesAnInclusionIsTiedWhereItBegins) {
  GridMesh grid = one(9, 6);
  grid.mesh.inclusions = {"bar"};
  const Decomposition result = cut_valid(grid.add({{2, 3}, {7, 3}}, {b, b, d, c, c}, 0));
  std::vector<Kind> kinds;
  kinds.reserve(result.interface_sides[0].size());
  for (const SidePair& sides : result.interface_sides[0]) {
    kinds.push_back(sides.kind);
  }
  EXPECT_THAT(kinds, ElementsAre(b, b, b, d, c, g));
  EXPECT_THAT(values(result, 0, 3), ElementsAre(::testing::Gt(0), 0));
  EXPECT_THAT(values(result, 0, 5)[0], values(result, 0, 5)[1]);
}

TEST(Ring, MayBeACrackWithinAMembraneIfAPartIsGlued) {
  GridMesh grid(8, 8, {"outside", "inside"},
                [](int i, int j) { return i >= 3 && i < 5 && j >= 3 && j < 5 ? 1 : 0; });
  // Counterclockwise: the inside is the plus side.
  const std::vector<GridMesh::Point> ring = {{3, 3}, {5, 3}, {5, 5}, {3, 5}, {3, 3}};
  GridMesh glued = grid;
  glued.add(ring, {g, g, c, c, c, c, c, c});
  const Decomposition result = cut_valid(glued);
  EXPECT_EQ(result.pairs.size(), 8U);
  EXPECT_EQ(result.skeleton.contacts.size(), 5U);
  EXPECT_EQ(result.skeleton.unknowns, 8U + 5);
  EXPECT_EQ(result.interface_sides[0].front().pair, result.interface_sides[0].back().pair);
  EXPECT_EQ(result.interface_sides[0].front().plus, 1);
  EXPECT_EQ(result.subdomains[1].floating.size(), 1U);
  EXPECT_THAT(uzawa_obstacle(result, glued.mesh), HasSubstr("\"inside\""));

  expect_refused(grid.add(ring, std::vector<Kind>(8, c)).mesh, Reason::numerical,
                 "nothing but contact holds the subdomain \"inside\" around (3, 3)");
}

TEST(Ring, OfADelaminatedInclusionIsAPlateThatOnlyContactHolds) {
  GridMesh grid(8, 8, {"outside", "inside"},
                [](int i, int j) { return i >= 3 && i < 5 && j >= 3 && j < 5 ? 1 : 0; });
  grid.mesh.inclusions = {"frame"};
  GridMesh out = grid;
  grid.add({{3, 3}, {5, 3}, {5, 5}, {3, 5}, {3, 3}}, std::vector<Kind>(8, d), 0);
  expect_refused(grid.mesh, Reason::numerical, "nothing but contact holds");
  // Clockwise: the outside carries the frame, the inside is pushed.
  out.add({{3, 3}, {3, 5}, {5, 5}, {5, 3}, {3, 3}}, {d, b, d, d, d, d, d, d}, 0);
  const Decomposition result = cut_valid(out);
  EXPECT_EQ(result.skeleton.unknowns, 1U + 6);
  EXPECT_EQ(result.skeleton.contacts.size(), 6U);
  EXPECT_THAT(result.subdomains[0].rigid, ::testing::Each(0));
  EXPECT_THAT(result.subdomains[1].rigid, ::testing::Each(-1));
}

TEST(Ring, WithinOneSubdomainCutsOffAPartThatFloats) {
  GridMesh grid = one(8, 8);
  grid.mesh.inclusions = {"frame"};
  grid.add({{3, 3}, {5, 3}, {5, 5}, {3, 5}, {3, 3}}, {b, c, c, c, c, c, c, c}, 0);
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.subdomains[0].trace, 16U);
  EXPECT_EQ(result.subdomains[0].floating.size(), 1U);
  EXPECT_EQ(result.skeleton.contacts.size(), 6U);
  EXPECT_EQ(result.skeleton.unknowns, 1U + 12);
}

/// Four squares of 4 x 4 around (4, 4): south-west 0, south-east 1, north-west 2, north-east 3.
GridMesh four() {
  return {8, 8, {"SW", "SE", "NW", "NE"}, [](int i, int j) { return i / 4 + 2 * (j / 4); }};
}

const std::vector<GridMesh::Point> west_east = {{0, 4}, {8, 4}}, south_north = {{4, 0}, {4, 8}};

TEST(CrossPoint, OfGlueHasOneValue) {
  GridMesh grid = four();
  const std::vector<Kind> glue(8, g);
  const Decomposition result = cut_valid(grid.add(west_east, glue).add(south_north, glue));
  EXPECT_EQ(result.skeleton.unknowns, 13U);
  EXPECT_EQ(result.pairs.size(), 12U + 4);
  for (const Subdomain& subdomain : result.subdomains) {
    EXPECT_EQ(subdomain.trace, 7U);
  }
  EXPECT_EQ(values(result, 0, 4), values(result, 1, 4));
  // Read towards the successor: the eastern edge has SE below and NE above.
  EXPECT_EQ(result.interface_sides[0][4].minus, 1);
  EXPECT_EQ(result.interface_sides[0][4].plus, 3);
}

TEST(CrossPoint, ACrackPassesAGluedWallAsOneContact) {
  GridMesh grid = four();
  grid.add(west_east, {g, g, c, c, c, c, g, g}).add(south_north, std::vector<Kind>(8, g));
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.skeleton.contacts.size(), 3U);
  EXPECT_EQ(result.skeleton.unknowns, 13U + 3);
  int shared = 0;
  for (const NodePair& pair : result.pairs) {
    if (pair.node == grid.node({4, 4}) && pair.unilateral()) {
      ++shared;
      EXPECT_EQ(pair.contact, 1);
    }
  }
  EXPECT_EQ(shared, 2);
}

TEST(CrossPoint, ACrackThatEndsInAGluedCrossIsTied) {
  GridMesh grid = four();
  grid.add(west_east, {g, g, c, c, g, g, g, g}).add(south_north, std::vector<Kind>(8, g));
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.skeleton.contacts.size(), 1U);
  EXPECT_EQ(values(result, 0, 4)[0], values(result, 0, 4)[1]);
  EXPECT_EQ(result.interface_sides[0][4].kind, Kind::glue);
}

TEST(CrossPoint, ACrackPassesATJunction) {
  GridMesh grid(8, 8, {"S", "NW", "NE"}, [](int i, int j) { return j < 4 ? 0 : 1 + i / 4; });
  grid.add(west_east, {g, g, g, c, c, g, g, g}).add({{4, 4}, {4, 8}}, std::vector<Kind>(4, g));
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.skeleton.contacts.size(), 1U);
  EXPECT_EQ(result.subdomains[0].trace, 7U);
  EXPECT_EQ(std::count_if(result.pairs.begin(), result.pairs.end(),
                          [](const NodePair& pair) { return pair.contact == 0; }),
            2);
  EXPECT_EQ(result.interface_sides[0][4].plus, 2);
}

TEST(CrossPoint, ACrackThatEndsOnACrackLeavesAChain) {
  GridMesh grid(8, 8, {"S", "NW", "NE"}, [](int i, int j) { return j < 4 ? 0 : 1 + i / 4; });
  grid.add(west_east, {g, g, g, c, c, g, g, g}).add({{4, 4}, {4, 8}}, {c, c, g, g});
  const Decomposition result = cut_valid(grid);
  // S <= NE <= NW (the plus side of the wall is its west), so S <= NW is implied.
  ASSERT_EQ(result.skeleton.contacts.size(), 2U + 1);
  const auto implied =
      std::find_if(result.pairs.begin(), result.pairs.end(),
                   [](const NodePair& p) { return p.unilateral() && p.contact < 0; });
  ASSERT_NE(implied, result.pairs.end());
  EXPECT_EQ(implied->minus, 0);
  EXPECT_EQ(implied->plus, 1);
}

TEST(CrossPoint, OneOfTheConditionsOfCracksThatCrossDependsOnTheOthers) {
  GridMesh grid = four();
  const std::vector<Kind> crack = {g, g, c, c, c, c, g, g};
  const Decomposition result = cut_valid(grid.add(west_east, crack).add(south_north, crack));
  EXPECT_EQ(result.skeleton.contacts.size(), 4U + 4);  // an edge from the cross point, and in it
  EXPECT_EQ(result.skeleton.independent, 4U + 3);
  ASSERT_EQ(result.skeleton.dependent.size(), 1U);
  double sum = 0;
  for (const Term& term : result.skeleton.dependent[0]) {
    EXPECT_EQ(std::abs(term.factor), 1);
    sum += term.factor;
  }
  EXPECT_EQ(sum, 1);  // d4 = d1 + d2 - d3
}

TEST(CrossPoint, SidesThatMayNotLieBelowEachOtherAllTheWayRoundAreTied) {
  GridMesh grid = four();
  const std::vector<Kind> out = {c, c, g, g};
  grid.add({{4, 4}, {8, 4}}, out).add({{4, 4}, {4, 8}}, out);
  grid.add({{4, 4}, {0, 4}}, out).add({{4, 4}, {4, 0}}, out);
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.skeleton.contacts.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(result.interface_sides[i][0].kind, Kind::glue);
    EXPECT_EQ(values(result, i, 0), values(result, 0, 0));
  }
}

TEST(CrossPoint, AnInclusionPassesAWall) {
  GridMesh grid = four();
  grid.mesh.inclusions = {"bar"};
  grid.add(west_east, {g, g, d, d, d, d, g, g}, 0).add(south_north, std::vector<Kind>(8, g));
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.skeleton.contacts.size(), 3U);
  for (const NodePair& pair : result.pairs) {
    if (pair.node == grid.node({4, 4})) {
      const bool above = pair.minus >= 2 && pair.plus >= 2, below = pair.minus < 2 && pair.plus < 2;
      EXPECT_EQ(pair.kind, above ? Kind::inclusion : below ? Kind::glue : Kind::delaminated);
    }
  }
  EXPECT_THAT(uzawa_obstacle(result, grid.mesh), HasSubstr("\"bar\" lies in two subdomains"));
}

TEST(CrossPoint, InclusionsThatShareANodeAreOneBody) {
  GridMesh grid = four();
  grid.mesh.inclusions = {"one", "two"};
  grid.add(west_east, {g, g, d, d, g, g, g, g}, 0).add(south_north, {g, g, g, g, d, d, g, g}, 1);
  const Decomposition result = cut_valid(grid);
  const Skeleton& skeleton = result.skeleton;
  ASSERT_EQ(skeleton.motions.size(), 2U);
  for (const RigidMotion& motion : skeleton.motions) {
    ASSERT_EQ(motion.displacement.size(), 1U);
    EXPECT_EQ(motion.displacement[0].index, 0);
    EXPECT_TRUE(motion.slope_x.empty());
  }
  EXPECT_THAT(uzawa_obstacle(result, grid.mesh), ::testing::HasSubstr("\"two\" shares nodes"));
}

TEST(CrossPoint, ABodyOfTwoDirectionsThatTiltsHasTwoSlopes) {
  GridMesh grid = four();
  grid.mesh.inclusions = {"one", "two"};
  grid.mesh.motions = {{true, {}}, {true, {}}};
  grid.add(west_east, {g, g, d, d, g, g, g, g}, 0).add(south_north, {g, g, g, g, d, d, g, g}, 1);
  const Skeleton skeleton = cut_valid(grid).skeleton;
  EXPECT_EQ(skeleton.motions[0].slope_x.size(), 2U);
  EXPECT_EQ(skeleton.motions[1].displacement.size(), 3U);
  EXPECT_THAT(mesh::why_none_tilts(grid.mesh), ::testing::ElementsAre("", ""));
  grid.mesh.motions[1].tilt = false;  // it keeps the direction of both
  EXPECT_TRUE(cut_valid(grid).skeleton.motions[0].slope_x.empty());
  EXPECT_THAT(
      why_none_tilts(grid.mesh),
      ::testing::ElementsAre(::testing::HasSubstr("\"two\" does not tilt: let that one"), ""));
  grid.mesh.motions[1].fixed = 1.0;
  EXPECT_THAT(mesh::why_none_tilts(grid.mesh),
              ::testing::ElementsAre(::testing::HasSubstr("\"two\" is held: do not hold"), ""));
  grid.mesh.motions = {{false, 1.0}, {false, 2.0}};
  expect_refused(grid.mesh, Reason::invalid_argument, "is fixed at 2, but shares nodes");
}

TEST(CrossPoint, ADiagonalPatternGivesASubdomainTwoSides) {
  GridMesh grid(8, 8, {"even", "odd"}, [](int i, int j) { return (i / 4 + j / 4) % 2; });
  const std::vector<Kind> glue(8, g);
  const Decomposition result = cut_valid(grid.add(west_east, glue).add(south_north, glue));
  EXPECT_EQ(result.skeleton.unknowns, 13U);
  for (const Subdomain& subdomain : result.subdomains) {
    EXPECT_EQ(subdomain.trace, 14U);
    EXPECT_TRUE(subdomain.floating.empty());
  }
}

TEST(Cut, RefusesGlueWithinASubdomain) {
  GridMesh grid = one(6, 6);
  expect_refused(grid.add({{2, 3}, {4, 3}}, {c, g}).mesh, Reason::mesh_invalid,
                 "from (3, 3) to (4, 3) is glue, but has the subdomain \"membrane\" on both sides");
}

TEST(Cut, RefusesAPartThatHasNothingToHoldIt) {
  GridMesh grid = one(3, 3);
  grid.mesh.dirichlet.clear();
  expect_refused(grid.mesh, Reason::mesh_invalid, "nothing holds the subdomain \"membrane\"");
  expect_refused(grid.mesh, Reason::mesh_invalid,
                 "the whole boundary of the membrane is Neumann's");
  GridMesh cut(6, 2, {"left", "right"}, [](int i, int) { return i / 3; });
  cut.mesh.dirichlet.clear();
  expect_refused(cut.add({{3, 0}, {3, 2}}, {g, c}).mesh, Reason::numerical,
                 "the whole boundary of the membrane is Neumann's");
}

TEST(Cut, FloatingSubdomainsInAChainAreHeldByTheLastOne) {
  GridMesh grid(9, 2, {"left", "middle", "right"}, [](int i, int) { return i / 3; });
  grid.release([](double x, double) { return x < 9; });
  grid.add({{3, 0}, {3, 2}}, {g, g}).add({{6, 0}, {6, 2}}, {g, c});
  const Decomposition result = cut_valid(grid);
  EXPECT_EQ(result.subdomains[0].floating.size(), 1U);
  EXPECT_EQ(result.subdomains[1].floating.size(), 1U);
  EXPECT_TRUE(result.subdomains[2].floating.empty());
  grid.mesh.interfaces[1].kind = {c, c};
  expect_refused(grid.mesh, Reason::numerical, "nothing but contact holds the subdomain \"left\"");
}

}  // namespace
}  // namespace anticrack::ddm
