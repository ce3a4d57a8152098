// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that hold the nodes of an interface twice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "mesher/import_samples.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using mesh::Kind;
using mesh::Mesh;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::import_sample;
using ::testing::IsEmpty;
using testing::MshFormat;
using testing::MshSample;
using testing::open_middle;
using ::testing::Pair;
using testing::square_sample;
using Points = std::vector<std::array<double, 2>>;

std::string refusal(const MshSample& sample) {
  const auto error = testing::error_of([&] { import_sample(sample); });
  return error && error->reason() == errors::Reason::mesh_invalid ? error->what() : "";
}

TEST(ImportDoubled, NodesOfACrackAreMadeOne) {
  for (const MshFormat format : testing::all_formats) {
    MshSample sample = square_sample("");
    open_middle(sample, {0});
    const Mesh mesh = import_sample(sample, {}, format);
    EXPECT_EQ(mesh.node_count(), 25U);
    ASSERT_EQ(mesh.interfaces.size(), 1U);
    EXPECT_THAT(testing::points_of(mesh, 0),
                (Points{{-1, 0}, {-0.5, 0}, {0, 0}, {0.5, 0}, {1, 0}}));
    EXPECT_THAT(mesh.interfaces[0].kind,
                ElementsAre(Kind::glue, Kind::crack, Kind::crack, Kind::glue));
    EXPECT_THAT(mesh.warnings,
                ElementsAre(HasSubstr("1 node that lies on another made one with it, as are 2 "
                                      "pairs of edges"),
                            AllOf(HasSubstr("2 edges in no curve group, the first at"),
                                  HasSubstr("lie on doubled nodes: taken for crack"))));
  }
}

TEST(ImportDoubled, OneLipOrBothMayCarryTheGroup) {
  for (const char* name : {"crack", "delaminated:fibre", "glue", "inclusion:fibre"}) {
    for (const int lips : {1, 2, 3}) {
      MshSample sample = square_sample("");
      open_middle(sample, {0});
      const int below = sample.node(0, 0);
      if ((lips & 1) != 0) testing::add_lines(sample, {{-0.5, 0}, {0, 0}, {0.5, 0}}, 9, name);
      if ((lips & 2) != 0) {
        sample.node(0, 0) = 7;
        testing::add_lines(sample, {{-0.5, 0}, {0, 0}, {0.5, 0}}, 9, lips == 2 ? name : "");
        for (std::size_t i = sample.lines.size() - 2; i < sample.lines.size(); ++i) {
          for (int& node : sample.lines[i].nodes) node = node == 7 ? 1000 : node;
        }
        sample.tags[12] = below;
      }
      const Mesh mesh = import_sample(sample);
      const auto kind = mesh.interfaces[0].kind[1];
      const std::string found = kind == Kind::crack       ? "crack"
                                : kind == Kind::glue      ? "glue"
                                : kind == Kind::inclusion ? "inclusion:fibre"
                                                          : "delaminated:fibre";
      EXPECT_EQ(found, name) << lips;
      EXPECT_EQ(mesh.interfaces[0].kind[2], kind);
      EXPECT_EQ(mesh.warnings.size(), 1U);
    }
  }
}

TEST(ImportDoubled, NamesOfOnesOwnOnTheLipsAreACrack) {
  MshSample sample = square_sample("gamma_c");
  open_middle(sample, {0});
  const Mesh mesh = import_sample(sample);
  EXPECT_THAT(mesh.interfaces[0].kind,
              ElementsAre(Kind::glue, Kind::crack, Kind::crack, Kind::glue));
  EXPECT_THAT(
      mesh.warnings.back(),
      HasSubstr("curve group 4 \"gamma_c\" lies on doubled nodes: taken for crack (2 edges)"));
}

TEST(ImportDoubled, SubdomainsMeshedSeparatelyAreGlued) {
  MshSample sample = square_sample("");
  open_middle(sample, {-1, -0.5, 0, 0.5, 1});
  Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.node_count(), 25U);
  EXPECT_THAT(testing::lengths(mesh), ElementsAre(Pair(Kind::glue, 2.0)));
  EXPECT_THAT(mesh.warnings.back(), HasSubstr("lie between two subdomains that were meshed "
                                              "separately: taken for glue"));
  // what has a name is what it is called
  testing::add_lines(sample, {{-0.5, 0}, {0, 0}}, 9, "crack:one");
  mesh = import_sample(sample);
  EXPECT_THAT(testing::lengths(mesh), ElementsAre(Pair(Kind::glue, 1.5), Pair(Kind::crack, 0.5)));
}

TEST(ImportDoubled, PartsOfOneSubdomainMeshedSeparatelyAreJoined) {
  MshSample sample = square_sample("");
  testing::make_one_surface(sample);
  open_middle(sample, {-1, -0.5, 0, 0.5, 1});
  const Mesh mesh = import_sample(sample);
  EXPECT_THAT(mesh.subdomains, ElementsAre("all"));
  EXPECT_THAT(mesh.interfaces, IsEmpty());
  EXPECT_EQ(mesh.dirichlet.size(), 16U);
  EXPECT_THAT(mesh.warnings.back(), HasSubstr("taken for one piece"));
}

TEST(ImportDoubled, ASlitLiesInsideOneSubdomain) {
  MshSample sample = square_sample("");
  testing::make_one_surface(sample);
  open_middle(sample, {0});
  const Mesh mesh = import_sample(sample);
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  EXPECT_THAT(testing::points_of(mesh, 0), (Points{{-0.5, 0}, {0, 0}, {0.5, 0}}));
  EXPECT_THAT(testing::lengths(mesh), ElementsAre(Pair(Kind::crack, 1.0)));
  EXPECT_THAT(mesh.warnings.back(), HasSubstr("interface: its plus side is taken to be the left, "
                                              "walked from (-0.5, 0) to (0, 0)"));
}

TEST(ImportDoubled, LinesOnALipSayWhichSideIsPlus) {
  MshSample sample = square_sample("");
  testing::make_one_surface(sample);
  testing::add_lines(sample, {{0.5, 0}, {0, 0}, {-0.5, 0}}, 9, "crack");
  open_middle(sample, {0});
  Mesh mesh = import_sample(sample);
  EXPECT_THAT(testing::points_of(mesh, 0), (Points{{0.5, 0}, {0, 0}, {-0.5, 0}}));
  EXPECT_EQ(mesh.warnings.size(), 1U);
  std::swap(sample.lines.back().nodes[0], sample.lines.back().nodes[1]);
  mesh = import_sample(sample);
  EXPECT_THAT(testing::points_of(mesh, 0), (Points{{-0.5, 0}, {0, 0}, {0.5, 0}}));
  EXPECT_THAT(mesh.warnings.back(), HasSubstr("the lines on it run both ways"));
}

TEST(ImportDoubled, ACrackMayOpenAtTheBoundary) {
  MshSample sample = square_sample("");
  open_middle(sample, {-1, -0.5});
  const Mesh mesh = import_sample(sample);
  EXPECT_THAT(mesh.interfaces[0].kind,
              ElementsAre(Kind::crack, Kind::crack, Kind::glue, Kind::glue));
  EXPECT_EQ(mesh.dirichlet.size(), 16U);
}

TEST(ImportDoubled, FourSquaresMeshedSeparatelyMeetInACrossPoint) {
  MshSample sample = square_sample("");
  const Points middle{{-1, 0}, {-0.5, 0}, {0, 0}, {0.5, 0}, {1, 0}};
  testing::double_nodes(sample, middle, [](double, double y) { return y > 0; });
  testing::double_nodes(sample, {{0, -1}, {0, -0.5}, {0, 0}},
                        [](double x, double y) { return x > 0 && y < 0; });
  // the upper copies of the middle are no longer found by their place
  sample.node(0, 0) = 1;
  for (auto& t : sample.triangles) {
    for (int& node : t.nodes) node = node == 130 ? 1 : node;
  }
  const int above = 1002;
  testing::double_nodes(sample, {{0, 0.5}, {0, 1}},
                        [](double x, double y) { return x > 0 && y > 0; });
  sample.tags.push_back(3000);
  sample.points.push_back({0, 0, 0});
  for (std::size_t i = 0; i < sample.triangles.size(); ++i) {
    auto& t = sample.triangles[i];
    const bool right = (i / 2) % 4 >= 2;
    for (int& node : t.nodes) node = right && node == above ? 3000 : node;
    t.group = (i >= 16 ? 3 : 1) + (right ? 1 : 0);
    t.entity = 20 + t.group;
  }
  sample.names = {{1, 3, "dirichlet"}};
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.node_count(), 25U);
  EXPECT_EQ(mesh.subdomains.size(), 4U);
  ASSERT_EQ(mesh.interfaces.size(), 4U);
  EXPECT_THAT(testing::lengths(mesh), ElementsAre(Pair(Kind::glue, 4.0)));
  for (std::size_t i = 0; i < 4; ++i) {
    const Points points = testing::points_of(mesh, i);
    const std::array<double, 2> origin{0, 0};
    EXPECT_TRUE(points.front() == origin || points.back() == origin);
    EXPECT_EQ(points.size(), 3U);
  }
}

TEST(ImportDoubled, AnIslandMeshedSeparatelyIsARing) {
  MshSample sample = square_sample("");
  const auto inside = [](double x, double y) { return std::abs(x) < 0.5 && std::abs(y) < 0.5; };
  testing::double_nodes(sample,
                        {{-0.5, -0.5},
                         {0, -0.5},
                         {0.5, -0.5},
                         {0.5, 0},
                         {0.5, 0.5},
                         {0, 0.5},
                         {-0.5, 0.5},
                         {-0.5, 0}},
                        inside);
  for (auto& t : sample.triangles) t.group = 1, t.entity = 21;
  for (const std::size_t square : {5U, 6U, 9U, 10U}) {
    for (const std::size_t i : {2 * square, 2 * square + 1}) {
      sample.triangles[i].group = 2, sample.triangles[i].entity = 22;
    }
  }
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.node_count(), 25U);
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  EXPECT_EQ(mesh.interfaces[0].nodes.size(), 9U);
  EXPECT_EQ(mesh.interfaces[0].nodes.front(), mesh.interfaces[0].nodes.back());
  EXPECT_THAT(testing::lengths(mesh), ElementsAre(Pair(Kind::glue, 4.0)));
  EXPECT_DOUBLE_EQ(testing::area_of(mesh, 1), 1);
}

TEST(ImportDoubled, RoundingDoesNotKeepNodesApartButAGapDoes) {
  MshSample sample = square_sample("");
  open_middle(sample, {0});
  sample.points.back() = {1e-11, 1e-11, 0};
  EXPECT_THAT(import_sample(sample).interfaces[0].kind,
              ElementsAre(Kind::glue, Kind::crack, Kind::crack, Kind::glue));
  // a notch of this width is a hole with a boundary of its own
  sample.points.back() = {0, 1e-6, 0};
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.node_count(), 26U);
  EXPECT_THAT(testing::lengths(mesh), ElementsAre(Pair(Kind::glue, 1.0)));
  EXPECT_THAT(mesh.warnings.back(), HasSubstr("4 edges in no curve group"));
}

TEST(ImportDoubled, AMeshGradedBelowTheToleranceKeepsItsNodes) {
  // a wedge of triangles that shrink by four towards its tip on the boundary
  MshSample sample;
  for (int i = 0; i < 26; ++i) {
    const double size = std::pow(0.25, i);
    sample.tags.insert(sample.tags.end(), {2 * i + 1, 2 * i + 2});
    sample.points.push_back({size, 0, 0});
    sample.points.push_back({0, size, 0});
    if (i == 0) continue;
    const int a = 2 * i - 1;
    sample.triangles.push_back({{a, a + 1, a + 2}, 1, 1});
    sample.triangles.push_back({{a + 1, a + 3, a + 2}, 1, 1});
  }
  EXPECT_EQ(import_sample(sample).node_count(), 52U);
}

/// Two triangles below, one above, (1, 0) between their common ends.
MshSample hanging(bool ends_doubled) {
  MshSample sample;
  sample.tags = {1, 2, 3, 4, 5, 6, 7};
  sample.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, -1, 0}, {1, 1, 0}, {0, 0, 0}, {2, 0, 0}};
  sample.triangles = {{{1, 4, 2}, 1, 1}, {{2, 4, 3}, 1, 1}, {{1, 3, 5}, 2, 2}};
  if (ends_doubled) sample.triangles[2].nodes = {6, 7, 5};
  return sample;
}

TEST(ImportDoubled, HangingNodesAreRefused) {
  EXPECT_THAT(
      refusal(hanging(false)),
      AllOf(HasSubstr("the edge from node 1 (0, 0) to node 3 (2, 0) lies on the edge from node "
                      "1 (0, 0) to node 2 (1, 0)"),
            HasSubstr("hanging node"), HasSubstr("Transfinite Curve")));
  EXPECT_THAT(
      refusal(hanging(true)),
      AllOf(HasSubstr("from node 6 (0, 0) to node 7 (2, 0) lies on the edge from node 1 (0, 0)"),
            HasSubstr("hanging node")));
}

TEST(ImportDoubled, CurvesMeshedDifferentlyAreRefused) {
  MshSample sample = hanging(true);
  // the chord of the upper side is not the lower side's
  sample.points[1] = {1, -0.125, 0};
  EXPECT_THAT(refusal(sample), AllOf(HasSubstr("node 1 (0, 0) lies on node 6 (0, 0), but no edge"),
                                     HasSubstr("the same nodes")));
}

TEST(ImportDoubled, NodesThatTouchWithoutAnEdgeAreRefused) {
  MshSample sample;
  sample.tags = {1, 2, 3, 4, 5, 6};
  sample.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 0}, {0, -1, 0}};
  sample.triangles = {{{1, 2, 3}, 1, 1}, {{4, 5, 6}, 2, 2}};
  EXPECT_THAT(refusal(sample), HasSubstr("node 1 (0, 0) lies on node 4 (0, 0)"));
}

TEST(ImportDoubled, TheSameMeshTwiceIsRefused) {
  MshSample sample = square_sample();
  const MshSample once = sample;
  for (std::size_t i = 0; i < once.tags.size(); ++i) {
    sample.tags.push_back(once.tags[i] + 1000);
    sample.points.push_back(once.points[i]);
  }
  for (auto t : once.triangles) {
    for (int& node : t.nodes) node += 1000;
    sample.triangles.push_back(t);
  }
  EXPECT_THAT(refusal(sample), AllOf(HasSubstr("triangles overlap at the edge from node"),
                                     HasSubstr("two lie on the same side")));
}

TEST(ImportDoubled, LipsCannotBeBoundary) {
  MshSample sample = square_sample("neumann");
  open_middle(sample, {0});
  EXPECT_THAT(refusal(sample), AllOf(HasSubstr("of curve group 4 \"neumann\" lies inside"),
                                     HasSubstr("call it \"crack\"")));
}

/// Whatever the order and the numbers, the same membrane is read.
TEST(ImportDoubled, NumbersAndOrderDoNotMatter) {
  constexpr unsigned seed = 20261;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  MshSample plain = square_sample("delaminated:fibre");
  open_middle(plain, {0});
  const Points expected = testing::points_of(import_sample(plain), 0);
  for (int round = 0; round < 50; ++round) {
    MshSample sample = plain;
    std::vector<std::size_t> order(sample.tags.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    std::map<int, int> renamed;
    int tag = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      tag += 1 + static_cast<int>(random() % 1000);
      renamed[plain.tags[order[i]]] = tag;
      sample.tags[i] = tag;
      sample.points[i] = plain.points[order[i]];
    }
    // entities stay together
    std::shuffle(sample.triangles.begin(), sample.triangles.begin() + 16, random);
    std::shuffle(sample.triangles.begin() + 16, sample.triangles.end(), random);
    for (auto& line : sample.lines) {
      for (int& node : line.nodes) node = renamed.at(node);
    }
    std::size_t turned = 0;
    for (auto& t : sample.triangles) {
      for (int& node : t.nodes) node = renamed.at(node);
      if (random() % 2 == 0) {
        std::swap(t.nodes[0], t.nodes[1]);
        ++turned;
      }
    }
    const Mesh mesh = import_sample(sample, {}, testing::all_formats[random() % 4]);
    ASSERT_EQ(testing::points_of(mesh, 0), expected);
    EXPECT_THAT(mesh.interfaces[0].kind,
                ElementsAre(Kind::glue, Kind::delaminated, Kind::delaminated, Kind::glue));
    EXPECT_EQ(mesh.warnings.size(), turned > 0 ? 2U : 1U);
  }
}

/// Wrong numbers in any place are refused, or give a mesh that holds together.
TEST(ImportDoubled, DamagedSamplesThrowOrImport) {
  constexpr unsigned seed = 20262;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::size_t refused = 0;
  std::size_t imported = 0;
  for (int round = 0; round < 1500; ++round) {
    MshSample sample = square_sample(round % 2 == 0 ? "crack" : "gamma");
    if (round % 3 != 0) open_middle(sample, {-0.5, 0, 0.5});
    for (std::size_t hits = 1 + random() % 2; hits > 0; --hits) {
      const auto any = [&](auto& of) -> auto& { return of[random() % of.size()]; };
      switch (random() % 6) {
        case 0:
          any(any(sample.triangles).nodes) = any(sample.tags);
          break;
        case 1:
          any(any(sample.lines).nodes) = any(sample.tags);
          break;
        case 2:
          any(sample.points) = any(sample.points);
          break;
        case 3: {
          auto& t = any(sample.triangles);
          t.group = static_cast<int>(random() % 4);
          t.entity = 20 + t.group;
          break;
        }
        case 4: {
          auto& line = any(sample.lines);
          line.group = static_cast<int>(random() % 6);
          line.entity = 10 + line.group;
          break;
        }
        default:
          sample.triangles.erase(sample.triangles.begin() +
                                 static_cast<std::ptrdiff_t>(random() % sample.triangles.size()));
      }
    }
    const auto error = testing::error_of([&] { import_sample(sample, {}, MshFormat::binary22); });
    if (error) {
      ASSERT_EQ(error->reason(), errors::Reason::mesh_invalid) << error->what();
      // validate finds nothing that was not refused in words
      ASSERT_THAT(error->what(), ::testing::Not(HasSubstr("kind"))) << round;
    }
    ++(error ? refused : imported);
  }
  EXPECT_GT(refused, 300U);
  EXPECT_GT(imported, 100U);
}

}  // namespace
}  // namespace anticrack
