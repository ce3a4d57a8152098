// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include "mesh/refine.hpp"
#include "mesh/refine_uniform.hpp"
#include "mesh/refinement_checks.hpp"
#include "mesh/refinement_mesh.hpp"

namespace anticrack::mesh {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::OnInterface;
using testing::structured_mesh;

/// Sixteen by four squares, so nodes of the interface are 1/8 apart.
std::vector<double> tips_on(const std::vector<OnInterface>& parts) {
  const Mesh made = structured_mesh(16, 4, parts);
  std::vector<double> x;
  for (const std::int32_t node : tips(made)) {
    EXPECT_EQ(testing::point(made, node)[1], 0);
    x.push_back(testing::point(made, node)[0]);
  }
  return x;
}

TEST(Tips, AreTheEndsOfADelaminatedInclusion) {
  EXPECT_THAT(tips_on({{-0.5, 0.5, Kind::delaminated, 0}}), ElementsAre(-0.5, 0.5));
}

TEST(Tips, AreTheEndsOfABondedInclusionAndOfACrack) {
  EXPECT_THAT(tips_on({{-0.5, -0.25, Kind::inclusion, 0}, {0.25, 0.5, Kind::crack, -1}}),
              ElementsAre(-0.5, -0.25, 0.25, 0.5));
}

TEST(Tips, AreTheEndsOfAFreeCrackAndWhereItsFacesBeginToTouch) {
  EXPECT_THAT(tips_on({{-0.5, 0, Kind::free, -1}, {0, 0.5, Kind::crack, -1}}),
              ElementsAre(-0.5, 0, 0.5));
}

TEST(Tips, AreWhereADelaminationEndsWithinItsInclusion) {
  EXPECT_THAT(tips_on({{-0.5, 0.5, Kind::inclusion, 0}, {-0.25, 0.125, Kind::delaminated, 0}}),
              ElementsAre(-0.5, -0.25, 0.125, 0.5));
}

TEST(Tips, AreWhereTwoInclusionsTouchThoughTheKindIsTheSame) {
  EXPECT_THAT(tips_on({{-0.5, 0, Kind::delaminated, 0}, {0, 0.5, Kind::delaminated, 1}}),
              ElementsAre(-0.5, 0, 0.5));
}

TEST(Tips, AreWhereACrackGoesOnFromAnInclusion) {
  EXPECT_THAT(tips_on({{-0.5, 0, Kind::delaminated, 0}, {0, 0.5, Kind::crack, -1}}),
              ElementsAre(-0.5, 0, 0.5));
}

TEST(Tips, AreNotWhereACrackLeavesThroughTheBoundary) {
  EXPECT_THAT(tips_on({{-1, 0.25, Kind::crack, -1}}), ElementsAre(0.25));
}

TEST(Tips, OfGlueAloneAreNone) { EXPECT_THAT(tips_on({}), IsEmpty()); }

TEST(Tips, AreTheFreeEndsOfASlitInOneSubdomain) {
  Mesh made = structured_mesh(16, 4, {});
  made.subdomain.assign(made.triangle_count(), 0);
  Interface& line = made.interfaces[0];
  const auto first = line.nodes[4];
  const auto last = line.nodes[9];
  line = {"slit", std::vector<std::int32_t>(line.nodes.begin() + 4, line.nodes.begin() + 10),
          std::vector<Kind>(5, Kind::crack), std::vector<std::int32_t>(5, -1)};
  EXPECT_THAT(tips(made), ElementsAre(first, last));
  line.kind.assign(5, Kind::glue);
  EXPECT_THAT(tips(made), IsEmpty());
}

TEST(Tips, AreTheEndsOfAnInclusionOnTheBoundary) {
  Mesh made = structured_mesh(16, 4, {});
  made.inclusions = {"rim"};
  made.interfaces.push_back({"bottom",
                             {5, 6, 7, 8},
                             std::vector<Kind>(3, Kind::inclusion),
                             std::vector<std::int32_t>(3, 0)});
  EXPECT_THAT(tips(made), ElementsAre(5, 8));
}

TEST(Tips, AreFoundWhereTwoInterfacesMeet) {
  Mesh made = structured_mesh(16, 4, {});
  // from the middle of sigma up to the boundary, through nodes one row apart
  const std::int32_t centre = made.interfaces[0].nodes[8];
  Interface branch{"branch", {centre, centre + 17, centre + 34}, {}, {-1, -1}};
  branch.kind.assign(2, Kind::glue);
  made.interfaces.push_back(branch);
  EXPECT_THAT(tips(made), IsEmpty());
  made.interfaces[1].kind[0] = Kind::crack;
  EXPECT_THAT(tips(made), ElementsAre(centre, centre + 17));
}

TEST(Tips, AreWhereAnInclusionCrossesGlueOnlyIfTheTensionJumpsThere) {
  Mesh made = structured_mesh(16, 4, {});
  made.inclusions = {"across"};
  const std::int32_t centre = made.interfaces[0].nodes[8];
  made.interfaces.push_back({"across",
                             {centre - 17, centre, centre + 17},
                             std::vector<Kind>(2, Kind::inclusion),
                             std::vector<std::int32_t>(2, 0)});
  made.tension = {1, 1};
  EXPECT_THAT(tips(made), ElementsAre(centre - 17, centre + 17));
  made.tension = {1, 2};
  EXPECT_THAT(tips(made), ElementsAre(centre - 17, centre, centre + 17));
  made.tension = {1, 1};
  made.tension_laws = {{}, {"1 + x^2", "", 0}};
  EXPECT_THAT(tips(made), ElementsAre(centre - 17, centre, centre + 17));
}

TEST(Tips, StayWhereTheyAreUnderRefinement) {
  const std::vector<OnInterface> parts{{-0.5, 0.5, Kind::inclusion, 0},
                                       {-0.25, 0.125, Kind::delaminated, 0}};
  const Mesh base = structured_mesh(16, 4, parts);
  EXPECT_EQ(tips(grade(base, {.h0 = 0.2}, 100'000)), tips(base));
  EXPECT_EQ(tips(refine_uniform(base)), tips(base));
}

}  // namespace
}  // namespace anticrack::mesh
