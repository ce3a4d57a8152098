// SPDX-License-Identifier: GPL-3.0-or-later
//
// What groups are taken for, with names, with a map, with neither.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "mesher/import_samples.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using errors::Reason;
using mesh::Kind;
using mesh::Mesh;
using mesh::MeshOptions;
using testing::add_lines;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::import_sample;
using ::testing::IsEmpty;
using testing::lengths;
using testing::MshSample;
using ::testing::Pair;
using testing::rename;
using testing::square_sample;
using Points = std::vector<std::array<double, 2>>;

/// What is wrong with options: the message, if the field is this one.
std::string fault(const MeshOptions& options, const std::string& field,
                  const MshSample& sample = square_sample()) {
  const auto error = testing::error_of([&] { import_sample(sample, options); });
  if (!error || error->reason() != Reason::invalid_argument) return "";
  return error->fields().size() == 1 && error->fields()[0].field == field ? error->what() : "";
}

TEST(ImportGroups, KeywordsAreReadInAnyCase) {
  MshSample sample = square_sample(" Delaminated: Fibre ");
  rename(sample, 1, 3, "DIRICHLET");
  const Mesh mesh = import_sample(sample);
  EXPECT_THAT(mesh.inclusions, ElementsAre("Fibre"));
  EXPECT_EQ(mesh.dirichlet.size(), 16U);
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

TEST(ImportGroups, NamesOfOnesOwnAreTakenByAdjacency) {
  MshSample sample = square_sample("gamma_c");
  rename(sample, 1, 3, "rim");
  add_lines(sample, {{-0.5, -0.5}, {0, -0.5}}, 8, "probe");
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.dirichlet.size(), 16U);
  EXPECT_THAT(lengths(mesh), ElementsAre(Pair(Kind::glue, 2.0)));
  EXPECT_THAT(
      mesh.warnings,
      ElementsAre(AllOf(HasSubstr("curve group 3 \"rim\" lies on the boundary: taken for dirichlet "
                                  "(16 edges); to choose, name it dirichlet or neumann, or give 3 "
                                  "a meaning in the groups")),
                  AllOf(HasSubstr("curve group 4 \"gamma_c\" lies between two subdomains: taken "
                                  "for glue (2 edges)"),
                        HasSubstr("delaminated:NAME")),
                  HasSubstr("curve group 8 \"probe\" lies inside one subdomain: taken for a line "
                            "the mesh follows, no interface (1 edge)"),
                  HasSubstr("2 edges in no curve group, the first at")));
}

TEST(ImportGroups, AGroupMayLiePartlyOnTheBoundary) {
  MshSample sample = square_sample("");
  add_lines(sample, {{-1, 0}, {-0.5, 0}, {0, 0}}, 8, "");
  sample.lines.erase(sample.lines.begin());
  add_lines(sample, {{-1, -1}, {-0.5, -1}}, 8, "");
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.dirichlet.size(), 16U);
  EXPECT_THAT(mesh.warnings,
              ElementsAre(HasSubstr("curve group 8 (no name) lies on the boundary: taken for "
                                    "dirichlet (1 edge)"),
                          HasSubstr("curve group 8 (no name) lies between two subdomains")));
}

TEST(ImportGroups, LinesOffTheMeshAreLeftOutUnlessTheyMeanSomething) {
  MshSample sample = square_sample();
  sample.tags.push_back(999);
  sample.points.push_back({3, 3, 0});
  sample.lines.push_back({{10, 999}, 8, 18});
  add_lines(sample, {{-1, -1}, {1, 1}}, 9, "diagonal");
  EXPECT_THAT(
      import_sample(sample).warnings,
      ElementsAre(HasSubstr("1 node that belongs"),
                  "curve group 8 (no name) has 1 line with nodes that belong to no triangle: left "
                  "out",
                  HasSubstr("curve group 9 \"diagonal\" lies on no edge of a triangle: left out")));
}

TEST(ImportGroups, AnEdgeInTwoGroupsTakesWhatTheyAgreeOn) {
  const Points middle{{-0.5, 0}, {0, 0}, {0.5, 0}};
  const auto kind = [&](const std::string& first, const std::string& second) {
    MshSample sample = square_sample(first);
    add_lines(sample, middle, 9, second);
    add_lines(sample, middle, 4, "");
    const Mesh mesh = import_sample(sample);
    EXPECT_THAT(mesh.warnings, IsEmpty());
    return mesh.interfaces[0].kind[1];
  };
  EXPECT_EQ(kind("upper_lip", "crack"), Kind::crack);
  EXPECT_EQ(kind("delaminated:a", "fibre"), Kind::delaminated);
  EXPECT_EQ(kind("crack:one", "crack"), Kind::crack);
  EXPECT_EQ(kind("crack:one", "crack:two"), Kind::crack);
  EXPECT_EQ(kind("free:one", "free"), Kind::free);
  EXPECT_EQ(kind("inclusion:a", "delaminated:a"), Kind::delaminated);
  EXPECT_EQ(kind("delaminated:a", "inclusion:a"), Kind::delaminated);
  for (const char* other : {"glue", "crack", "free:c", "inclusion:b", "delaminated:b"}) {
    MshSample sample = square_sample("inclusion:a");
    add_lines(sample, middle, 9, other);
    const auto error = testing::error_of([&] { import_sample(sample); });
    ASSERT_TRUE(error) << other;
    EXPECT_THAT(error->what(),
                HasSubstr("the edge (-0.5, 0)-(0, 0) is in curve group 4 \"inclusion:a\" and in "
                          "curve group 9 \"" +
                          std::string(other) + "\""));
  }
}

TEST(ImportGroups, TheMapWins) {
  MshSample sample = square_sample("anything");
  MeshOptions options;
  options.curve_groups = {{4, "Inclusion:Rod"}, {3, "dirichlet"}};
  options.surface_groups = {{1, "lower"}, {2, "upper"}};
  const Mesh mesh = import_sample(sample, options);
  EXPECT_THAT(mesh.subdomains, ElementsAre("lower", "upper"));
  EXPECT_THAT(mesh.inclusions, ElementsAre("Rod"));
  EXPECT_THAT(lengths(mesh), ElementsAre(Pair(Kind::glue, 1.0), Pair(Kind::inclusion, 1.0)));
  // also over a keyword
  options.curve_groups[4] = "glue";
  EXPECT_THAT(lengths(import_sample(square_sample("crack"), options)),
              ElementsAre(Pair(Kind::glue, 2.0)));
}

TEST(ImportGroups, SurfacesOfOneNameInTheMapAreOneSubdomain) {
  MeshOptions options;
  options.surface_groups = {{1, "all"}, {2, "all"}};
  const Mesh mesh = import_sample(square_sample("crack"), options);
  EXPECT_THAT(mesh.subdomains, ElementsAre("all"));
  EXPECT_THAT(lengths(mesh), ElementsAre(Pair(Kind::crack, 1.0)));
  options.surface_groups = {{1, "plus"}};
  const auto error = testing::error_of([&] { import_sample(square_sample(), options); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("surfaces 1 and 2 have the same name, \"plus\""));
}

TEST(ImportGroups, AMapThatDoesNotFitIsRefused) {
  MeshOptions options;
  options.curve_groups = {{7, "crack"}};
  EXPECT_THAT(fault(options, "options.curve_groups[7]"),
              HasSubstr("the file has no curve group 7; its curve groups are 3, 4"));
  options.curve_groups = {{4, "fissure"}};
  EXPECT_THAT(
      fault(options, "options.curve_groups[4]"),
      AllOf(HasSubstr(
                "curve group 4 is given as \"fissure\"; choose dirichlet, dirichlet:NAME, neumann"),
            HasSubstr("delaminated:NAME")));
  options.curve_groups = {{4, "inclusion"}};
  EXPECT_THAT(fault(options, "options.curve_groups[4]"),
              HasSubstr("which takes a name, \"inclusion:NAME\""));
  options.curve_groups = {{4, ""}};
  EXPECT_THAT(fault(options, "options.curve_groups[4]"), HasSubstr("is given as \"\""));
  options.curve_groups.clear();
  options.surface_groups = {{3, "third"}};
  EXPECT_THAT(fault(options, "options.surface_groups[3]"),
              HasSubstr("the file has no surface group 3; its surface groups are 1, 2"));
  options.surface_groups = {{1, "a b"}};
  EXPECT_THAT(
      fault(options, "options.surface_groups[1]"),
      HasSubstr("surface group 1 is given the name \"a b\"; a subdomain's name is a letter"));
  MshSample bare = square_sample();
  bare.lines.clear();
  bare.names.clear();
  options = {};
  options.curve_groups = {{1, "crack"}};
  EXPECT_THAT(fault(options, "options.curve_groups[1]", bare),
              HasSubstr("the file has no curve group 1; it has no lines at all"));
}

TEST(ImportGroups, ALongListOfTagsIsCut) {
  MshSample sample = square_sample();
  for (int tag = 20; tag < 60; ++tag) sample.names.push_back({1, tag, "n" + std::to_string(tag)});
  MeshOptions options;
  options.curve_groups = {{7, "crack"}};
  EXPECT_THAT(fault(options, "options.curve_groups[7]", sample),
              HasSubstr("3, 4, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, "
                        "37 and 22 more"));
}

TEST(ImportGroups, TensionIsPerSubdomain) {
  MeshOptions options;
  EXPECT_THAT(import_sample(square_sample()).tension, IsEmpty());
  options.tension = {{"plus", 2.5}};
  EXPECT_THAT(import_sample(square_sample(), options).tension, ElementsAre(1, 2.5));
  options.tension = {{"top", 1}};
  EXPECT_THAT(
      fault(options, "options.tension[top]"),
      HasSubstr("tension is given for \"top\", which is not a subdomain; they are \"minus\", "
                "\"plus\""));
  for (const double value : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    options.tension = {{"minus", value}};
    EXPECT_THAT(fault(options, "options.tension[minus]"),
                AllOf(HasSubstr("the tension of \"minus\" is "), HasSubstr("above 0")));
  }
}

TEST(ImportGroups, ALawIsThatOfItsSubdomain) {
  MeshOptions options;
  options.tension_laws = {{"plus", {"1 + x", "2", 30}}};
  EXPECT_THAT(import_sample(square_sample(), options).tension_laws,
              ElementsAre(mesh::TensionLaw{}, options.tension_laws["plus"]));
  options.tension_laws = {{"top", {"1", "", 0}}};
  EXPECT_THAT(fault(options, "options.tension_laws[top]"), HasSubstr("which is not a subdomain"));
}

TEST(ImportGroups, AnInclusionMovesAsTheOptionsSay) {
  EXPECT_THAT(import_sample(square_sample()).motions, IsEmpty());
  MeshOptions options;
  options.inclusion_motions = {{"stiffener", {false, 0.25}}};
  EXPECT_THAT(import_sample(square_sample(), options).motions,
              ElementsAre(mesh::Motion{false, 0.25}));
  options.inclusion_motions = {{"fibre", {true, {}}}};
  EXPECT_EQ(fault(options, "options.inclusion_motions[fibre]"),
            "\"fibre\" is not an inclusion of the file; they are \"stiffener\"");
  EXPECT_EQ(fault(options, "options.inclusion_motions[fibre]", square_sample("free:fibre")),
            "\"fibre\" is not an inclusion of the file; it has none");
}

TEST(ImportGroups, ABoundaryThatIsFreeIsCalledNeumann) {
  MshSample sample = square_sample();
  rename(sample, 1, 3, "free");
  const auto error = testing::error_of([&] { import_sample(sample); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("may lie on the boundary: one that is free is \"neumann\""));
}

TEST(ImportGroups, WithoutAnyGroupAdjacencyDecides) {
  MshSample sample = square_sample("anything");
  testing::remove_groups(sample);
  add_lines(sample, {{-0.5, -0.5}, {0, -0.5}}, 0, "");
  for (const auto format : testing::all_formats) {
    const Mesh mesh = import_sample(sample, {}, format);
    EXPECT_THAT(mesh.subdomains, ElementsAre("21", "22"));
    EXPECT_EQ(mesh.dirichlet.size(), 16U);
    EXPECT_THAT(lengths(mesh), ElementsAre(Pair(Kind::glue, 2.0)));
    EXPECT_THAT(
        mesh.warnings,
        ElementsAre("the file has no physical surface: its surfaces are the subdomains \"21\", "
                    "\"22\"",
                    HasSubstr("curve 11 (in no group) lies on the boundary: taken for dirichlet"),
                    HasSubstr("curve 12 (in no group) lies between two subdomains: taken for glue"),
                    HasSubstr("curve 100 (in no group) lies inside one subdomain"),
                    HasSubstr("2 edges in no curve group, the first at (-1, 0), lie between two "
                              "subdomains: taken for glue")));
  }
}

TEST(ImportGroups, ThenTheMapSpeaksOfElementaryTags) {
  MshSample sample = square_sample("anything");
  testing::remove_groups(sample);
  MeshOptions options;
  options.curve_groups = {{11, "neumann"}, {12, "crack"}};
  const auto error = testing::error_of([&] { import_sample(sample, options); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("nothing holds the membrane"));
  options.curve_groups[11] = "dirichlet";
  options.surface_groups = {{21, "minus"}, {22, "other"}};
  const Mesh mesh = import_sample(sample, options);
  EXPECT_THAT(mesh.subdomains, ElementsAre("minus", "other"));
  EXPECT_THAT(mesh.interfaces[0].kind,
              ElementsAre(Kind::glue, Kind::crack, Kind::crack, Kind::glue));
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

TEST(ImportGroups, WithoutLinesTheBoundaryIsHeld) {
  MshSample sample = square_sample("");
  testing::remove_groups(sample);
  sample.lines.clear();
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.dirichlet.size(), 16U);
  EXPECT_THAT(mesh.warnings, Contains(HasSubstr("16 edges in no curve group, the first at (-1, "
                                                "-1), lie on the boundary: taken for dirichlet")));
}

TEST(ImportGroups, ASingleSurfaceIsPartedByItsLines) {
  MshSample sample = square_sample("");
  add_lines(sample, {{-1, 0}, {-0.5, 0}, {0, 0}, {0.5, 0}, {1, 0}}, 5, "");
  testing::remove_groups(sample);
  for (auto& t : sample.triangles) t.entity = 1;
  Mesh mesh = import_sample(sample);
  EXPECT_THAT(mesh.subdomains, ElementsAre("1", "2"));
  EXPECT_DOUBLE_EQ(testing::area_of(mesh, 0), 2);
  EXPECT_THAT(lengths(mesh), ElementsAre(Pair(Kind::glue, 2.0)));
  EXPECT_THAT(mesh.warnings[0], HasSubstr("the 2 pieces into which its lines cut it are the "
                                          "subdomains \"1\", \"2\""));
  // a line that ends inside parts nothing
  sample.lines.pop_back();
  mesh = import_sample(sample);
  EXPECT_THAT(mesh.subdomains, ElementsAre("1"));
  EXPECT_THAT(mesh.interfaces, IsEmpty());
  EXPECT_THAT(mesh.warnings[0], HasSubstr("it is one subdomain, \"1\""));
  // nor does a surface that has a name
  MeshOptions options;
  options.surface_groups = {{1, "plate"}};
  EXPECT_THAT(import_sample(sample, options).subdomains, ElementsAre("plate"));
}

TEST(ImportGroups, ASurfaceWithoutGroupInTheMapKeepsItsNumber) {
  MshSample sample = square_sample("");
  testing::remove_groups(sample);
  MeshOptions options;
  options.surface_groups = {{22, "top"}};
  EXPECT_THAT(import_sample(sample, options).subdomains, ElementsAre("21", "top"));
}

TEST(ImportGroups, KeywordsInsideOneSubdomainAreSlits) {
  MshSample sample = square_sample("crack");
  testing::make_one_surface(sample);
  Mesh mesh = import_sample(sample);
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  EXPECT_THAT(testing::points_of(mesh, 0), (Points{{-0.5, 0}, {0, 0}, {0.5, 0}}));
  EXPECT_THAT(mesh.warnings, IsEmpty());
  // glue asks for what holds there anyway
  rename(sample, 1, 4, "glue");
  mesh = import_sample(sample);
  EXPECT_THAT(mesh.interfaces, IsEmpty());
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

/// Parts of the boundary as NAME: points.
std::map<std::string, Points> parts_of(const Mesh& mesh) {
  std::map<std::string, Points> parts;
  for (const mesh::BoundaryPart& part : mesh.boundary_parts)
    parts[part.name] = {testing::point_of(mesh, part.first), testing::point_of(mesh, part.last)};
  EXPECT_EQ(parts.size(), mesh.boundary_parts.size());
  return parts;
}

/// The square with lines of its own on each side, in the groups 5 to 8 of these names.
MshSample square_with_sides(const std::array<std::string, 4>& names) {
  MshSample sample = square_sample();
  std::erase_if(sample.lines, [](const testing::MshLine& line) { return line.group == 3; });
  std::erase_if(sample.names, [](const testing::MshName& name) { return name.tag == 3; });
  const Points corners{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  for (std::size_t side = 0; side < 4; ++side) {
    Points line;
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0})
      line.push_back({std::lerp(corners[side][0], corners[side + 1][0], t),
                      std::lerp(corners[side][1], corners[side + 1][1], t)});
    if (side % 2 == 1) std::reverse(line.begin(), line.end());  // as a file may have them
    add_lines(sample, line, 5 + static_cast<int>(side), names[side]);
  }
  return sample;
}

TEST(ImportGroups, PartsOfTheBoundaryHaveTheNamesOfTheirGroups) {
  MeshOptions options;
  options.curve_groups = {{6, "neumann"}, {7, "neumann:above"}};
  const Mesh mesh =
      import_sample(square_with_sides({"dirichlet:foot", "right", "top", ""}), options);
  EXPECT_THAT(parts_of(mesh),
              ::testing::UnorderedElementsAre(Pair("foot", Points{{-1, -1}, {1, -1}}),
                                              Pair("right", Points{{1, -1}, {1, 1}}),
                                              Pair("above", Points{{1, 1}, {-1, 1}}),
                                              Pair("group-8", Points{{-1, 1}, {-1, -1}})));
  EXPECT_EQ(mesh.dirichlet.size(), 8U);
  EXPECT_THAT(import_sample(square_with_sides({"dirichlet", "neumann", "", ""}),
                            {.curve_groups = {{7, "dirichlet"}}})
                  .boundary_parts,
              ::testing::SizeIs(2));  // keywords are no names
  MshSample bare = square_with_sides({"", "", "", ""});
  testing::remove_groups(bare);
  EXPECT_THAT(import_sample(bare).boundary_parts, IsEmpty());
}

TEST(ImportGroups, APartOfTheBoundaryMayBeARingOrInPieces) {
  MshSample sample = square_sample();
  rename(sample, 1, 3, "rim");
  const std::vector<mesh::BoundaryPart> ring = import_sample(sample).boundary_parts;
  ASSERT_EQ(ring.size(), 1U);
  EXPECT_EQ(ring[0].name, "rim");
  EXPECT_EQ(ring[0].first, ring[0].last);
  const Mesh mesh = import_sample(square_with_sides({"ends", "long", "", ""}),
                                  {.curve_groups = {{7, "dirichlet:ends"}, {8, "dirichlet:long"}}});
  std::vector<std::string> names;
  for (const mesh::BoundaryPart& part : mesh.boundary_parts) names.push_back(part.name);
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("ends", "long", "ends", "long"));
}

TEST(ImportGroups, NamesOfTheBoundaryThatCannotBeAreSaid) {
  MshSample sample = square_with_sides({"a", "left side", "c", "d"});
  add_lines(sample, {{-1, -1}, {-0.5, -1}}, 9, "corner");
  Mesh mesh = import_sample(sample);
  EXPECT_EQ(parts_of(mesh).count("group-6"), 1U);
  EXPECT_EQ(parts_of(mesh).count("corner"), 0U);
  EXPECT_THAT(mesh.warnings,
              AllOf(Contains(HasSubstr("curve group 6 \"left side\" is group-6 in answers: a name "
                                       "there is a letter")),
                    Contains(HasSubstr("the edge (-1, -1)-(-0.5, -1) is in curve group 5 \"a\" and "
                                       "in curve group 9 \"corner\": answers count its force for "
                                       "a alone"))));
  // a NAME of the boundary decides, but two do not go together
  rename(sample, 1, 9, "dirichlet:corner");
  EXPECT_EQ(parts_of(import_sample(sample)).at("corner"), (Points{{-1, -1}, {-0.5, -1}}));
  rename(sample, 1, 5, "Dirichlet: foot");
  const auto error = testing::error_of([&] { import_sample(sample); });
  ASSERT_TRUE(error);
  EXPECT_THAT(error->what(), HasSubstr("which do not go together"));
}

TEST(ImportGroups, WhereTheBoundaryTouchesItselfAPartHasNoName) {
  MshSample sample = square_with_sides({"a", "b", "c", "d"});
  // without the squares above and below (-0.5, 0) on the left, but for one corner
  std::map<int, std::array<double, 3>> place;
  for (std::size_t i = 0; i < sample.tags.size(); ++i) place[sample.tags[i]] = sample.points[i];
  std::erase_if(sample.triangles, [&](const testing::MshTriangle& t) {
    double x = 0, y = 0;
    for (const int node : t.nodes) x += place[node][0] / 3, y += place[node][1] / 3;
    return (x > -0.5 && x < 0 && y > -0.5 && y < 0) || (x > 0 && x < 0.5 && y > 0 && y < 0.5);
  });
  std::erase_if(sample.lines, [](const testing::MshLine& line) { return line.group == 4; });
  add_lines(sample, {{-0.5, 0}, {-0.5, -0.5}, {0, -0.5}}, 9, "neumann:hole");
  add_lines(sample, {{0, 0}, {0, 0.5}, {0.5, 0.5}}, 10, "neumann:other");
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(parts_of(mesh).at("hole"), (Points{{0, -0.5}, {-0.5, 0}}));
  EXPECT_EQ(parts_of(mesh).count("other"), 0U);
  EXPECT_THAT(mesh.warnings, Contains(HasSubstr("touches itself in a node: what begins there of "
                                                "\"other\" counts as \"boundary\"")));
}

TEST(ImportGroups, CracksThatCrossEndInTheirCommonNode) {
  MshSample sample = square_sample("crack:along");
  testing::make_one_surface(sample);
  add_lines(sample, {{0, -0.5}, {0, 0}, {0, 0.5}}, 5, "crack:across");
  const Mesh mesh = import_sample(sample);
  ASSERT_EQ(mesh.interfaces.size(), 4U);
  EXPECT_EQ(mesh.interfaces[3].name, "interface-4");
  EXPECT_THAT(lengths(mesh), ElementsAre(Pair(Kind::crack, 2.0)));
  for (std::size_t i = 0; i < 4; ++i) {
    const std::array<double, 2> origin{0, 0};
    const Points points = testing::points_of(mesh, i);
    EXPECT_TRUE(points.front() == origin || points.back() == origin);
  }
}

TEST(ImportGroups, ASlitThatMeetsAnInterfaceEndsItsChains) {
  MshSample sample = square_sample("delaminated:fibre");
  add_lines(sample, {{0, 0}, {0, 0.5}}, 5, "crack");
  const Mesh mesh = import_sample(sample);
  ASSERT_EQ(mesh.interfaces.size(), 3U);
  EXPECT_THAT(testing::points_of(mesh, 0), (Points{{-1, 0}, {-0.5, 0}, {0, 0}}));
  EXPECT_THAT(testing::points_of(mesh, 1), (Points{{0, 0}, {0.5, 0}, {1, 0}}));
  EXPECT_THAT(testing::points_of(mesh, 2), (Points{{0, 0}, {0, 0.5}}));
}

const Points ring{{-0.5, -0.5}, {-0.5, 0},   {-0.5, 0.5}, {0, 0.5},    {0.5, 0.5},
                  {0.5, 0},     {0.5, -0.5}, {0, -0.5},   {-0.5, -0.5}};

TEST(ImportGroups, ARingKeepsTheDirectionOfItsLines) {
  MshSample sample = square_sample("");
  testing::make_one_surface(sample);
  add_lines(sample, ring, 5, "crack");
  Mesh mesh = import_sample(sample);
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  EXPECT_EQ(testing::points_of(mesh, 0), ring);
  EXPECT_THAT(mesh.warnings, IsEmpty());
  // without a direction the plus side is inside
  std::swap(sample.lines.back().nodes[0], sample.lines.back().nodes[1]);
  mesh = import_sample(sample);
  EXPECT_EQ(testing::points_of(mesh, 0), Points(ring.rbegin(), ring.rend()));
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("run both ways")));
}

TEST(ImportGroups, AnIslandIsARing) {
  MshSample sample = square_sample("");
  for (auto& t : sample.triangles) t.group = 1, t.entity = 21;
  for (const std::size_t square : {5U, 6U, 9U, 10U}) {
    for (const std::size_t i : {2 * square, 2 * square + 1}) {
      sample.triangles[i].group = 2, sample.triangles[i].entity = 22;
    }
  }
  const Mesh mesh = import_sample(sample);
  ASSERT_EQ(mesh.interfaces.size(), 1U);
  // surface 2 is plus and inside, so on the left counterclockwise
  EXPECT_EQ(testing::points_of(mesh, 0), Points(ring.rbegin(), ring.rend()));
  EXPECT_THAT(lengths(mesh), ElementsAre(Pair(Kind::glue, 4.0)));
}

TEST(ImportGroups, CracksMayReachTheBoundaryAndShareTips) {
  MshSample sample = square_sample("crack");
  add_lines(sample, {{-1, 0}, {-0.5, 0}}, 5, "inclusion:stub");
  const Mesh mesh = import_sample(sample);
  EXPECT_THAT(mesh.interfaces[0].kind,
              ElementsAre(Kind::inclusion, Kind::crack, Kind::crack, Kind::glue));
}

TEST(ImportGroups, TheLinesOfACrackDecideBeforeThoseOfGlue) {
  MshSample sample = square_sample("delaminated:fibre");
  rename(sample, 2, 1, "a");
  rename(sample, 2, 2, "b");
  add_lines(sample, {{-0.5, 0}, {-1, 0}}, 5, "glue");
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(testing::points_of(mesh, 0).front()[0], -1);
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

TEST(ImportGroups, ManyWarningsAreCut) {
  MshSample sample = square_sample();
  for (int tag = 100; tag < 300; ++tag) add_lines(sample, {{-1, -0.5}, {-0.5, -0.5}}, tag, "");
  const Mesh mesh = import_sample(sample);
  EXPECT_EQ(mesh.warnings.size(), 101U);
  EXPECT_EQ(mesh.warnings.back(), "and 100 more");
}

}  // namespace
}  // namespace anticrack
