// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refusals.hpp"

namespace anticrack {
namespace {

using errors::Reason;
using mesh::Geometry;
using mesh::Shape;
using testing::add;
using testing::infinite;
using testing::nan_value;

TEST(MeshOptions, SizeMustBeAnEdgeLength) {
  for (const double size : {-0.1, nan_value, infinite}) {
    EXPECT_TRUE(testing::throws(
        [&] {
          mesh::plan(testing::paper_geometry(), {.preset = mesh::Preset::uniform, .size = size},
                     1000);
        },
        Reason::invalid_argument, "options.size"));
  }
  EXPECT_TRUE(testing::throws(
      [] {
        mesh::plan(testing::paper_geometry(), {.preset = mesh::Preset::paper, .size = 0.1},
                   100'000);
      },
      Reason::invalid_argument, "options.size"));
}

TEST(MeshOptions, CoarseIsGradedFromASizeFourTimesAsLarge) {
  const auto plan = [](const mesh::MeshOptions& options) {
    return mesh::plan(testing::paper_geometry(), options, 100'000);
  };
  const mesh::Plan graded = plan({}), coarse = plan({.preset = mesh::Preset::coarse});
  EXPECT_EQ(coarse.grading.h0, 4 * graded.grading.h0);
  EXPECT_EQ(coarse.grading.m, graded.grading.m);
  EXPECT_LT(coarse.triangles, graded.triangles);
  const mesh::Plan given = plan({.preset = mesh::Preset::coarse, .size = 0.1, .tip_size = 1e-3});
  EXPECT_EQ(given.grading.h0, 0.1);
  EXPECT_EQ(given.grading.tip_size, 1e-3);
}

void expect_refused(const mesh::MeshOptions& options, const std::string& field,
                    Reason reason = Reason::invalid_argument) {
  EXPECT_TRUE(testing::throws([&] { mesh::plan(testing::paper_geometry(), options, 100'000); },
                              reason, field));
}

TEST(MeshOptions, AreThoseOfAGeometry) {
  for (const double size : {-1.0, nan_value, infinite}) {
    expect_refused({.tip_size = size}, "options.tip_size");
  }
  for (const double grading : {0.0, -0.1, 1.1, nan_value}) {
    expect_refused({.grading = grading}, "options.grading");
  }
  for (const double angle : {-1.0, 45.1, nan_value})
    expect_refused({.chord_angle = angle}, "options.chord_angle");
  expect_refused({.size = 0.1, .tip_size = 0.2}, "options.tip_size");
  expect_refused({.preset = mesh::Preset::uniform, .tip_size = 0.01}, "options.tip_size");
  expect_refused({.curve_groups = {{1, "crack"}}}, "options.curve_groups");
  expect_refused({.surface_groups = {{1, "left"}}}, "options.surface_groups");
  expect_refused({.tension = {{"left", 1}}}, "options.tension");
  expect_refused({.inclusion_motions = {{"fibre", {true, {}}}}}, "options.inclusion_motions");
}

TEST(MeshOptions, AlignLinesAreCheckedAsInterfaces) {
  const auto line = [](std::vector<mesh::Point> points) {
    return mesh::MeshOptions{.align = {std::move(points)}};
  };
  const auto bad = Reason::geometry_invalid;
  expect_refused(line({{0, 0}}), "options.align[0]", bad);
  expect_refused(line({{0, 0.5}, {nan_value, 0}}), "options.align[0].points[1]", bad);
  expect_refused(line({{0, 0.5}, {0, 1.5}}), "options.align[0]", bad);
  expect_refused(line({{-0.5, 0}, {0.5, 0}}), "options.align[0]", bad);
  expect_refused(line({{0, 0.5}, {0.5, 0.5}, {0.5, 0.75}, {0.25, 0.25}}), "options.align[0]", bad);
  expect_refused({.align = std::vector<std::vector<mesh::Point>>(1'001)}, "options.align",
                 Reason::limit_exceeded);
}

TEST(MeshOptions, PaperIsForOnePolylineThatCuts) {
  const auto refused = [](const std::function<void(Geometry&)>& change) {
    Geometry geometry = testing::paper_geometry();
    change(geometry);
    return testing::throws([&] { mesh::plan(geometry, testing::paper_options(), 1'000'000); },
                           Reason::invalid_argument, "options.preset");
  };
  EXPECT_FALSE(refused([](Geometry&) {}));
  EXPECT_TRUE(refused([](Geometry& g) { add(g, "b", {{-1, 0.5}, {1, 0.5}}); }));
  EXPECT_TRUE(refused([](Geometry& g) { g.interfaces[0].points[0] = {-0.75, 0}; }));
  EXPECT_TRUE(refused([](Geometry& g) {
    g.inclusions.clear();
    g.interfaces.clear();
  }));
  EXPECT_TRUE(refused([](Geometry& g) {
    g.inclusions.clear();
    g.interfaces = {{"a", Shape::arc, {{-1, 0}, {0, 0.5}, {1, 0}}, false}};
  }));
}

TEST(MeshOptions, OfAnUploadAreChecked) {
  const auto refused = [](const mesh::MeshOptions& options, const std::string& field) {
    EXPECT_TRUE(
        testing::throws([&] { mesh::check_for_upload(options); }, Reason::invalid_argument, field));
  };
  refused({.preset = mesh::Preset::paper}, "options.preset");
  refused({.size = nan_value}, "options.size");
  refused({.align = {{{0, 0}, {1, 0}}}}, "options.align");
  refused({.chord_angle = 5}, "options.chord_angle");
  for (const char* name : {"", "fibre", "dirichlet:", "neumann:a b", "inclusion",
                           "inclusion:", "crack:1", "free:", "delaminated:a b"}) {
    refused({.curve_groups = {{3, name}}}, "options.curve_groups[3]");
  }
  refused({.surface_groups = {{-7, "a/b"}}}, "options.surface_groups[-7]");
  refused({.tension = {{"a", 0}}}, "options.tension[a]");
  refused({.tension = {{"a", infinite}}}, "options.tension[a]");
  refused({.inclusion_motions = {{"a", {false, nan_value}}}}, "options.inclusion_motions[a]");
  refused({.inclusion_motions = {{"a", {true, 1}}}}, "options.inclusion_motions[a]");
  EXPECT_NO_THROW(mesh::check_for_upload({.size = 0.1,
                                          .tip_size = 1e-6,
                                          .curve_groups = {{1, "dirichlet"},
                                                           {2, "neumann"},
                                                           {3, "crack"},
                                                           {4, "crack:c"},
                                                           {5, "inclusion:a"},
                                                           {6, "delaminated:a"},
                                                           {7, "glue"},
                                                           {8, "free"},
                                                           {9, "free:f"},
                                                           {10, "dirichlet:a"},
                                                           {11, "neumann:b"}},
                                          .surface_groups = {{1, "left"}},
                                          .tension = {{"left", 2}},
                                          .inclusion_motions = {{"a", {true, {}}}}}));
}

}  // namespace
}  // namespace anticrack
