// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/sweep_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "client/sample_sweep.hpp"
#include "figures/figures.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::bounded_sweep;
using anticrack::testing::sample_sweep;
using anticrack::testing::TemporaryFolder;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::vector<Output> png{{Format::png, "a.png"}};

TEST(SweepAxis, IsTheCoefficientThatVaries) {
  results::Result result = sample_sweep(3);
  result.sweep->coefficients = {1, 0.5, 1, -2, 1, 3};
  const SweepAxis axis = sweep_axis(*result.sweep);
  EXPECT_EQ(axis.label, "coefficient of opening");
  EXPECT_TRUE(axis.joined());
  EXPECT_THAT(axis.position, ElementsAre(0.5, -2, 3));
  EXPECT_THAT(axis.order, ElementsAre(1, 0, 2));
}

TEST(SweepAxis, IsTheRowWhereSeveralVaryOrNone) {
  results::Result result = sample_sweep(3);
  for (const std::vector<double>& coefficients :
       std::vector<std::vector<double>>{{1, 2, 3, 4, 5, 6}, {1, 2, 1, 2, 1, 2}, {}}) {
    result.sweep->coefficients = coefficients;
    const SweepAxis axis = sweep_axis(*result.sweep);
    EXPECT_EQ(axis.label, "row");
    EXPECT_FALSE(axis.joined());
    EXPECT_THAT(axis.position, ElementsAre(0, 1, 2));
  }
}

TEST(SweepAxis, IsTheAngleOfTwoThatGoRoundACircle) {
  results::Result result = sample_sweep(5);
  result.sweep->coefficients = {2, 0, 0, 2, -2, 0, 0, -2, 2, 0};
  const SweepAxis turn = sweep_axis(*result.sweep);
  EXPECT_EQ(turn.label, "angle from skew to opening [°]");
  EXPECT_TRUE(turn.joined());
  EXPECT_THAT(turn.position, ElementsAre(0, 90, 180, 270, 360));
  EXPECT_THAT(turn.order, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(script(sweep_picture(result, turn), png), HasSubstr("set xtics 90\n"));

  // Of more than one turn, rows at the same angle stand at the same place.
  const double x = -1, y = std::sqrt(3.0);
  result.sweep->coefficients = {2, 0, x, y, x, -y, 2, 0, x, y};
  EXPECT_THAT(
      sweep_axis(*result.sweep).position,
      ElementsAre(0, DoubleNear(120, 1e-9), DoubleNear(-120, 1e-9), 0, DoubleNear(120, 1e-9)));
}

TEST(SweepCurve, LeavesAGapWhereARowDidNotConverge) {
  const results::Result result = sample_sweep(4);
  const results::Sweep& sweep = *result.sweep;
  const auto points = curve(sweep, sweep_axis(sweep), sweep.energy, 0, 1, 100);
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[0].y, -2);
  EXPECT_TRUE(std::isnan(points[2].y));
  EXPECT_EQ(points[3].x, 1);
}

TEST(SweepCurve, OfManyRowsKeepsTheExtremes) {
  results::Result result = sample_sweep(10'000);
  results::Sweep& sweep = *result.sweep;
  sweep.energy[1234] = -100;
  sweep.energy[7777] = 100;
  const auto points = curve(sweep, sweep_axis(sweep), sweep.energy, 0, 1, 50);
  EXPECT_LE(points.size(), 100U);
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  EXPECT_EQ(low->y, -100);
  EXPECT_EQ(high->y, 100);
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end(),
                             [](const auto& a, const auto& b) { return a.x < b.x; }));
}

TEST(ContactMap, CoversTheCrackOncePerRow) {
  const results::Result result = sample_sweep(5);
  const ContactMap map = contact_map(result, sweep_axis(*result.sweep), 0, 100);
  EXPECT_EQ(map.position_label, "x");
  EXPECT_FALSE(map.shades);
  double area = 0, closed = 0;
  for (const ContactBox& box : map.boxes) {
    const double size = (box.end - box.begin) * (box.high - box.low);
    area += size;
    closed += size * box.closed;
  }
  // Nodes -0.4 to 0.4 stand for 0.9 of length; a row for 0.5 of the coefficient; one row of five
  // did not converge. Closed are 9, 7, 4 and 0 nodes.
  EXPECT_NEAR(area, 4 * 0.5 * 0.9, 1e-12);
  EXPECT_NEAR(closed, 0.5 * 0.1 * (9 + 7 + 4 + 0), 1e-12);
}

TEST(ContactMap, OfManyRowsHasShades) {
  const results::Result result = sample_sweep(1000);
  const ContactMap map = contact_map(result, sweep_axis(*result.sweep), 0, 7);
  EXPECT_TRUE(map.shades);
  std::set<double> heights;
  bool between = false;
  for (const ContactBox& box : map.boxes) {
    heights.insert(box.low);
    between = between || (box.closed > 0 && box.closed < 1);
  }
  EXPECT_EQ(heights.size(), 7U);
  EXPECT_TRUE(between);
}

TEST(ContactMap, IsEmptyWhereThereIsNoCrack) {
  results::Result result = sample_sweep(5);
  result.sweep->contact.clear();
  result.sweep->contact_nodes.clear();
  EXPECT_THAT(contact_map(result, sweep_axis(*result.sweep), 0, 100).boxes, IsEmpty());
}

TEST(SweepScript, HasACurvePerInclusionAndKeepsStrangeNamesQuoted) {
  results::Result result = sample_sweep(3);
  result.sweep->inclusions = {"one", "t'wo\n!rm"};
  result.sweep->displacement = {1, 2, 3, 4, 5, 6};
  const std::string drawn = script(sweep_picture(result, sweep_axis(*result.sweep)), png);
  EXPECT_THAT(drawn, HasSubstr("$A1 << EOD"));
  EXPECT_THAT(drawn, HasSubstr("title 'one'"));
  EXPECT_THAT(drawn, HasSubstr("title 't''wo !rm'"));
  EXPECT_THAT(drawn, HasSubstr("'coefficient of opening'"));
  EXPECT_THAT(drawn, HasSubstr("3 rows, 1 without an answer left out"));
}

TEST(SweepScript, DrawsTheBoundsOfRowsThatAreJoined) {
  results::Result result = anticrack::testing::bounded_sweep(5);
  const std::string drawn = script(sweep_picture(result, sweep_axis(*result.sweep)), png);
  EXPECT_THAT(drawn, HasSubstr("$lower0 << EOD\n-1 -0.11\n"));
  EXPECT_THAT(drawn, HasSubstr("$upper0 << EOD\n-1 -0.09\n"));
  EXPECT_THAT(drawn, HasSubstr("; thin: bounds"));
  result.sweep->coefficients.clear();  // rows in no order
  EXPECT_THAT(script(sweep_picture(result, sweep_axis(*result.sweep)), png),
              Not(HasSubstr("$lower0")));
}

TEST(SweepScript, DrawsTheSlopesOneAboveTheOther) {
  results::Result result = anticrack::testing::tilting_sweep(3);
  result.sweep->inclusions = {"one", "two"};
  result.sweep->displacement = {1, 2, 3, 4, 5, 6};
  result.sweep->slope = {11, 21, 12, 22, 13, 23, 14, 24, 15, 25, 16, 26};
  const std::string drawn = script(slope_picture(result, sweep_axis(*result.sweep)), png);
  EXPECT_THAT(drawn, HasSubstr("$Bx1 << EOD\n-1 12\n"));
  EXPECT_THAT(drawn, HasSubstr("$By0 << EOD\n-1 21\n"));
  EXPECT_THAT(drawn, HasSubstr("'Bx'"));
  EXPECT_THAT(drawn, HasSubstr("'By'"));
  EXPECT_EQ(drawn.find("title 'two'"), drawn.rfind("title 'two'")) << "one legend for both";
}

TEST(SweepScript, CountsInclusionsThatAreTooManyToName) {
  results::Result result = sample_sweep(3);
  result.sweep->inclusions.clear();
  result.sweep->displacement.clear();
  for (int i = 0; i < 9; ++i) result.sweep->inclusions.push_back("fibre " + std::to_string(i));
  result.sweep->displacement.assign(27, 0.1);
  const std::string drawn = script(sweep_picture(result, sweep_axis(*result.sweep)), png);
  EXPECT_THAT(drawn, HasSubstr("title 'fibre 5'"));
  EXPECT_THAT(drawn, Not(HasSubstr("title 'fibre 6'")));
  EXPECT_THAT(drawn, HasSubstr("title '3 more'"));
}

TEST(SweepScript, LabelsRowsWithWholeNumbersAndKeepsTheUnitOfALongName) {
  results::Result result = sample_sweep(3);
  result.sweep->loads[1] = "a load whose name is longer than an axis";
  EXPECT_EQ(sweep_axis(*result.sweep).label, "coefficient of a load whose name i\xE2\x80\xA6");
  result.sweep->coefficients.clear();
  EXPECT_THAT(script(sweep_picture(result, sweep_axis(*result.sweep)), png),
              HasSubstr("set xtics 1\n"));
}

TEST(ContactScript, HasNoSeamsBetweenRows) {
  results::Result result = sample_sweep(5);
  for (auto& status : result.sweep->status) status = results::Status::converged;
  const SweepAxis axis = sweep_axis(*result.sweep);
  ContactMap map;
  map.boxes = {{0, 1, 0, 1, 1}, {0, 1, 1, 2, 1}, {0, 1, 3, 4, 1}};
  const std::string drawn = script(contact_picture(result, axis, map), png);
  EXPECT_THAT(drawn, HasSubstr("\n0.5 1 0 1 0 2 1\n"));    // reaches under the next
  EXPECT_THAT(drawn, HasSubstr("\n0.5 1.5 0 1 1 2 1\n"));  // not into a gap
}

TEST(DrawSweep, MakesThePicturesOfTheSweepAndOfItsFirstKeptRows) {
  const TemporaryFolder folder;
  const Drawn drawn = draw(sample_sweep(21), folder.path());
  std::set<std::string> names;
  for (const auto& file : drawn.files) {
    names.insert(file.filename());
    EXPECT_GT(std::filesystem::file_size(file), 5000U) << file;
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"sweep.png", "sweep.svg", "sweep-contact.png",
                                   "sweep-contact.svg", "row-0-traces.png", "row-0-traces.svg",
                                   "row-20-traces.png", "row-20-traces.svg"}));
  EXPECT_THAT(drawn.notes, IsEmpty());
}

TEST(DrawSweep, DrawsSlopesWhereAnInclusionTilted) {
  results::Result result = anticrack::testing::tilting_sweep(21);
  result.sweep->kept.clear();
  result.loads.clear();
  const TemporaryFolder folder;
  draw(result, folder.path());
  EXPECT_GT(std::filesystem::file_size(folder / "sweep-slope.png"), 5000U);
  result.sweep->slope.assign(42, 0.0);
  const TemporaryFolder other;
  draw(result, other.path());
  EXPECT_FALSE(std::filesystem::exists(other / "sweep-slope.png"));
}

TEST(DrawSweep, SaysThatBoundsOfRowsAreNotDrawn) {
  const TemporaryFolder folder;
  results::Result result = bounded_sweep(4);
  result.sweep->kept.clear();
  result.loads.clear();
  for (double& one : result.sweep->coefficients) one = one * one + 1;  // on no circle
  result.sweep->coefficients[0] = 7;
  EXPECT_THAT(draw(result, folder.path()).notes, ElementsAre(HasSubstr("--csv has the bounds")));
}

TEST(DrawSweep, SaysThatThereIsNothingToDraw) {
  const TemporaryFolder folder;
  results::Result result = sample_sweep(3);
  result.sweep->status.assign(3, results::Status::cancelled);
  result.sweep->kept.clear();
  result.loads.clear();
  const Drawn drawn = draw(result, folder.path());
  EXPECT_THAT(drawn.files, IsEmpty());
  EXPECT_THAT(drawn.notes, ElementsAre(HasSubstr("no row of the sweep converged")));
}

}  // namespace
}  // namespace anticrack::figures
