// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where fronts are, and paths that are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "growth/fronts.hpp"
#include "growth/on_line.hpp"
#include "support/errors.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::growth {
namespace {

using errors::Reason;
using mesh::Kind;
using testing::on_line;
using testing::throws;

/// Along y = 0: glue up to -3/4, an inclusion that has come off or may do so up to 1/4, which goes
/// on bonded up to 1/2, and glue. Arc length is x + 1.
mesh::Mesh line(Kind from_left = Kind::delaminated) {
  testing::StructuredOptions options;
  options.kind = [=](double x) {
    if (x < -0.75 || x > 0.5) return Kind::glue;
    return x < 0.25 ? from_left : Kind::inclusion;
  };
  return testing::structured_mesh(options);
}

TEST(Fronts, AreWhereAPathMeetsWhatIsOpen) {
  const mesh::Mesh mesh = line();
  const Path to_bonded = on_line(0.75, 1.25, "1 + x"), to_end = on_line(0.25, 0.5, "2");
  const Fronts right = find_fronts(mesh, std::vector{to_bonded});
  const Fronts turned =
      find_fronts(mesh, std::vector{Path{"sigma", to_bonded.to, to_bonded.from, "1 + x"}});
  EXPECT_EQ(right.fronts[0].track.position, turned.fronts[0].track.position);
  ASSERT_EQ(right.fronts.size(), 1U);
  const Track& track = right.fronts[0].track;
  EXPECT_DOUBLE_EQ(track.position.front(), 0.75);
  EXPECT_DOUBLE_EQ(track.position.back(), 1.25);
  EXPECT_DOUBLE_EQ(track.toughness.front(), 0.75);
  EXPECT_FALSE(track.breaks_through);  // the inclusion is bonded beyond
  const Fronts left = find_fronts(mesh, std::vector{to_end});
  ASSERT_EQ(left.fronts.size(), 1U);
  EXPECT_DOUBLE_EQ(left.fronts[0].track.position.front(), 0.5);
  EXPECT_DOUBLE_EQ(left.fronts[0].track.position.back(), 0.25);
  EXPECT_TRUE(left.fronts[0].track.breaks_through);  // the inclusion ends
  EXPECT_EQ(left.fronts[0].track.facing, -1);
  const Fronts bridge = find_fronts(mesh, std::vector{on_line(0.5, 1, "2")});
  ASSERT_EQ(bridge.fronts.size(), 2U);
  EXPECT_EQ(bridge.fronts[0].track.facing, 1);
  EXPECT_EQ(bridge.fronts[1].track.facing, 0);
  EXPECT_TRUE(bridge.fronts[0].track.breaks_through && bridge.fronts[1].track.breaks_through);
}

TEST(Fronts, OfPathsThatAreNoneAreRefused) {
  const auto find = [](const mesh::Mesh& mesh, std::vector<Path> paths) {
    return [=] { find_fronts(mesh, paths); };
  };
  const mesh::Mesh open = line();
  const Path good = on_line(0.75, 1.25, "1");
  using Paths = std::vector<Path>;
  EXPECT_TRUE(throws(find(open, {}), Reason::invalid_argument, "paths"));
  // nothing open meets it
  EXPECT_TRUE(throws(find(open, {on_line(0.25, 1.25, "1")}), Reason::invalid_argument, "paths[0]"));
  // beyond the interface, of no length, without a number
  for (const auto& [from, to] :
       {std::pair{0.75, 2.5}, {-1.0, 0.5}, {1.0, 1.0}, {std::nan(""), 1.0}, {0.75, HUGE_VAL}})
    EXPECT_TRUE(throws(find(open, Paths{good, on_line(from, to, "1")}), Reason::invalid_argument,
                       "paths[1]"))
        << from << " " << to;
  Path other = good;
  other.interface = "tau";
  EXPECT_TRUE(throws(find(open, {other}), Reason::invalid_argument, "paths[0]"));
  other = good;
  other.to[1] = 0.3;  // beside the line
  EXPECT_TRUE(throws(find(open, {other}), Reason::invalid_argument, "paths[0]"));
  // glue and what is bonded do not come off
  EXPECT_TRUE(throws(find(open, {on_line(0.75, 1.4, "1")}), Reason::invalid_argument, "paths[0]"));
  EXPECT_TRUE(throws(find(open, {on_line(0.1, 0.5, "1")}), Reason::invalid_argument, "paths[0]"));
  EXPECT_TRUE(throws(find(line(Kind::inclusion), {good}), Reason::invalid_argument, "paths[0]"));
  // two paths that share a node
  EXPECT_TRUE(
      throws(find(open, {good, on_line(0.5, 0.75, "1")}), Reason::invalid_argument, "paths[1]"));
  for (const std::string bad : {"0", "-1", "x - 0.1", "0/0"})
    EXPECT_TRUE(testing::error_of(find(open, {on_line(0.75, 1.25, bad)})).has_value()) << bad;
  EXPECT_TRUE(throws(find(open, {on_line(0.75, 1.25, "1 +")}), Reason::expression_invalid));
}

}  // namespace
}  // namespace anticrack::growth
