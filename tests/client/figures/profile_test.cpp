// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/profile.hpp"

#include <gtest/gtest.h>

#include "support/sample_result.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::sample_pair;
using anticrack::testing::sample_result;
using anticrack::testing::set_edges;
using results::Kind;

TEST(Profile, marks_the_delaminated_part_from_tip_to_tip) {
  const auto result = sample_result(20);
  const Profile seen = profile(result, 0, result.loads[0].traces[0]);
  EXPECT_EQ(seen.axis, "x");
  ASSERT_EQ(seen.delaminated.size(), 1u);
  EXPECT_NEAR(seen.delaminated[0].begin, -0.5, 1e-12);
  EXPECT_NEAR(seen.delaminated[0].end, 0.5, 1e-12);
  EXPECT_TRUE(seen.crack.empty());
  EXPECT_TRUE(seen.bonded.empty());
  EXPECT_TRUE(seen.contact.empty());
}

TEST(Profile, contact_has_its_lumped_length) {
  const auto result = sample_result(20);
  const Profile seen = profile(result, 0, result.loads[1].traces[0]);
  ASSERT_EQ(seen.contact.size(), 1u);
  EXPECT_NEAR(seen.contact[0].begin, -0.475, 1e-12);  // the tip itself is tied
  EXPECT_NEAR(seen.contact[0].end, -0.175, 1e-12);
}

TEST(Profile, a_single_node_in_contact_can_be_seen) {
  auto result = sample_result(20);
  auto trace = result.loads[0].traces[0];
  trace.contact[20] = 1;
  const Profile seen = profile(result, 0, trace);
  ASSERT_EQ(seen.contact.size(), 1u);
  EXPECT_NEAR(seen.contact[0].end - seen.contact[0].begin, 0.05, 1e-12);
}

TEST(Profile, tells_the_kinds_apart) {
  auto result = sample_result(10);
  // An inclusion from x = -0.5 to 0.5, bonded right of 0; a crack from 0.7 to 0.9, free from 0.8
  // on.
  set_edges(result.interfaces[0], 10, 15, Kind::inclusion, 0);
  set_edges(result.interfaces[0], 17, 18, Kind::crack, -1);
  set_edges(result.interfaces[0], 18, 19, Kind::free, -1);
  const Profile seen = profile(result, 0, result.loads[0].traces[0]);
  ASSERT_EQ(seen.delaminated.size(), 1u);
  EXPECT_NEAR(seen.delaminated[0].end, 0.0, 1e-12);
  ASSERT_EQ(seen.bonded.size(), 1u);
  EXPECT_NEAR(seen.bonded[0].begin, 0.0, 1e-12);
  EXPECT_NEAR(seen.bonded[0].end, 0.5, 1e-12);
  ASSERT_EQ(seen.crack.size(), 1u);
  EXPECT_NEAR(seen.crack[0].begin, 0.7, 1e-12);
  EXPECT_NEAR(seen.crack[0].end, 0.8, 1e-12);
  ASSERT_EQ(seen.free.size(), 1u);
  EXPECT_NEAR(seen.free[0].begin, 0.8, 1e-12);
  EXPECT_NEAR(seen.free[0].end, 0.9, 1e-12);
}

TEST(Profile, takes_bonded_and_delaminated_parts_for_one_fibre) {
  auto result = sample_result(10);
  set_edges(result.interfaces[0], 10, 15, Kind::inclusion, 0);
  set_edges(result.interfaces[0], 17, 19, Kind::crack, -1);
  const Profile seen = profile(result, 0, result.loads[0].traces[0]);
  ASSERT_EQ(seen.fibres.size(), 1u);
  EXPECT_NEAR(seen.fibres[0].band.begin, -0.5, 1e-12);
  EXPECT_NEAR(seen.fibres[0].band.end, 0.5, 1e-12);
  EXPECT_EQ(seen.fibres[0].inclusion, "fibre");
}

TEST(Profile, tells_inclusions_of_one_displacement_apart) {
  auto result = sample_pair(10);
  const auto seen = [&] { return profile(result, 0, result.loads[0].traces[0]).fibres; };
  ASSERT_EQ(seen().size(), 2u);
  EXPECT_EQ(seen()[0].inclusion, "left");
  EXPECT_NEAR(seen()[0].band.begin, -0.5, 1e-12);
  EXPECT_NEAR(seen()[0].band.end, 0, 1e-12);
  EXPECT_EQ(seen()[1].inclusion, "right");
  EXPECT_NEAR(seen()[1].band.end, 0.5, 1e-12);
  // Walked the other way, they are still in the order of the axis.
  for (double& x : result.interfaces[0].x) x = -x;
  ASSERT_EQ(seen().size(), 2u);
  EXPECT_EQ(seen()[0].inclusion, "right");
  EXPECT_NEAR(seen()[0].band.begin, -0.5, 1e-12);
}

TEST(Profile, names_no_inclusion_where_it_is_not_known_which) {
  auto result = sample_result(10);
  set_edges(result.interfaces[0], 5, 15, Kind::delaminated, -1);
  const Profile seen = profile(result, 0, result.loads[0].traces[0]);
  EXPECT_TRUE(seen.fibres.empty());
  EXPECT_EQ(seen.delaminated.size(), 1u);
}

TEST(Profile, takes_the_axis_the_interface_lies_along) {
  auto result = sample_result(10);
  auto& interface = result.interfaces[0];
  const auto& trace = result.loads[0].traces[0];
  std::swap(interface.x, interface.y);
  EXPECT_EQ(profile(result, 0, trace).axis, "y");
  interface.x[3] = 0.2;
  EXPECT_EQ(profile(result, 0, trace).axis,
            "arc length s from (0, \xE2\x88\x92"
            "1)");
}

TEST(Profile, runs_backwards_along_x_too) {
  auto result = sample_result(10);
  auto& interface = result.interfaces[0];
  for (double& x : interface.x) x = -x;
  const Profile seen = profile(result, 0, result.loads[1].traces[0]);
  EXPECT_EQ(seen.axis, "x");
  ASSERT_EQ(seen.contact.size(), 1u);
  EXPECT_LT(seen.contact[0].begin, seen.contact[0].end);
  EXPECT_NEAR(seen.contact[0].end, 0.45, 1e-12);
}

TEST(Profile, of_nothing_is_empty) {
  results::Result result;
  result.interfaces.emplace_back();
  EXPECT_TRUE(profile(result, 0, {}).position.empty());
}

}  // namespace
}  // namespace anticrack::figures
