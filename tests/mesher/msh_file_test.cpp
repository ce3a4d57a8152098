// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/msh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

#include "mesher/msh_writer.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using errors::Reason;
using ::testing::HasSubstr;
using testing::MshFormat;
using testing::MshSample;
using testing::square_sample;
using testing::write_msh;

constexpr std::size_t enough = 1000;

class EachFormat : public ::testing::TestWithParam<MshFormat> {
 protected:
  static std::string bytes(const MshSample& sample = square_sample()) {
    return write_msh(sample, GetParam());
  }
  static std::string refusal(const std::string& file, std::size_t limit = enough) {
    const auto error = testing::error_of([&] { mesher::read_msh(file, limit); });
    return error && error->reason() == Reason::mesh_invalid ? error->what() : "";
  }
};

std::string format_name(const ::testing::TestParamInfo<MshFormat>& info) {
  constexpr std::array names{"ascii22", "binary22", "ascii41", "binary41"};
  return names[static_cast<std::size_t>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(Msh, EachFormat, ::testing::ValuesIn(testing::all_formats), format_name);

TEST_P(EachFormat, IsRead) {
  const MshSample sample = square_sample();
  const mesher::MshFile file = mesher::read_msh(bytes(sample), enough);
  ASSERT_EQ(file.node_tags.size(), 25U);
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_EQ(file.node_tags[i], static_cast<std::uint64_t>(sample.tags[i]));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(file.xyz[3 * i + k], sample.points[i][k]);
  }
  ASSERT_EQ(file.triangles.size(), 32U);
  EXPECT_EQ(file.triangles[31].group, 2);
  EXPECT_EQ(file.triangles[31].entity, 22);
  EXPECT_EQ(file.triangles[31].nodes, (std::array<std::uint64_t, 3>{190, 250, 240}));
  ASSERT_EQ(file.lines.size(), 18U);
  EXPECT_EQ(file.lines[17].group, 4);
  EXPECT_EQ(file.lines[17].nodes, (std::array<std::uint64_t, 2>{130, 140}));
  EXPECT_EQ(file.surface_names.at(2), "plus");
  EXPECT_EQ(file.curve_names.at(4), "delaminated:stiffener");
}

TEST_P(EachFormat, OtherSectionsArePassedOver) {
  std::string file = bytes();
  const std::string extra = "$Comments\nany $thing\n$EndComments\n";
  file.insert(file.find("$Nodes"), extra);
  EXPECT_EQ(mesher::read_msh(file + extra, enough).triangles.size(), 32U);
}

TEST_P(EachFormat, TruncationAtEveryByteIsRefused) {
  const std::string file = bytes();
  // without its last line break the file is whole
  for (std::size_t n = 0; n + 1 < file.size(); ++n) {
    const std::string cut = file.substr(0, n);
    ASSERT_NE(refusal(cut), "") << n << " of " << file.size();
  }
}

TEST_P(EachFormat, DamagedBytesThrowOrReadButDoNothingElse) {
  const std::string sound = bytes();
  std::mt19937 random(7);
  std::size_t refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string file = sound;
    for (int hits = 0; hits < 3; ++hits) {
      file[random() % file.size()] = static_cast<char>(random() % 256);
    }
    if (testing::error_of([&] { mesher::read_msh(file, enough); })) ++refused;
  }
  EXPECT_GT(refused, 300U);
}

TEST_P(EachFormat, MoreTrianglesThanTheLimitAreRefused) {
  EXPECT_TRUE(testing::throws([&] { mesher::read_msh(bytes(), 31); }, Reason::limit_exceeded));
  EXPECT_NO_THROW(mesher::read_msh(bytes(), 32));
}

TEST_P(EachFormat, CoordinatesThatAreNotFiniteAreRefused) {
  MshSample sample = square_sample();
  sample.points[3][1] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(bytes(sample)), HasSubstr("y of node 40 is not a finite number"));
  sample.points[3] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  EXPECT_THAT(refusal(bytes(sample)), HasSubstr("x of node 40"));
}

TEST_P(EachFormat, NamesUsedTwiceAreRefused) {
  MshSample sample = square_sample();
  sample.names.push_back({1, 9, "dirichlet"});
  EXPECT_THAT(refusal(bytes(sample)), HasSubstr("physical curves 3 and 9 are both named"));
  sample = square_sample();
  sample.names.push_back({2, 9, "plus"});
  EXPECT_THAT(refusal(bytes(sample)), HasSubstr("physical surfaces 2 and 9 are both named"));
}

struct Text {
  const char* name;
  std::string file;
  std::string message;
};

void PrintTo(const Text& text, std::ostream* out) { *out << text.name; }

class RefusedText : public ::testing::TestWithParam<Text> {};

TEST_P(RefusedText, SaysWhy) {
  const auto error = testing::error_of([&] { mesher::read_msh(GetParam().file, enough); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::mesh_invalid);
  EXPECT_THAT(error->what(), HasSubstr(GetParam().message));
}

const std::string head22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string head41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string nodes22 = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n";

std::string with_element(const std::string& element) {
  return head22 + nodes22 + "$Elements\n1\n" + element + "\n$EndElements\n";
}

const Text texts[] = {
    {"Empty", "", "truncated"},
    {"Geo", "SystemCall \"true\";\n", "expected $MeshFormat"},
    {"BinaryGarbage", std::string("\x7f\x00\xff\x01garbage", 11), "expected $MeshFormat"},
    {"Format1", "$NOD\n1\n", "expected $MeshFormat"},
    {"Format40", "$MeshFormat\n4 0 8\n$EndMeshFormat\n", "format 4 is not read; convert it"},
    {"NoMesh41", head41 + "$Entities\n1 0 0 0\n1 0 0 0 0\n$EndEntities\n",
     "geometry but no mesh; mesh it before saving (gmsh"},
    {"EntitiesLate",
     head41 + "$Elements\n0 0 0 0\n$EndElements\n$Entities\n0 0 0 0\n$EndEntities\n",
     "must stand before $Elements"},
    {"NodesTwice", head22 + nodes22 + "$ParametricNodes\n0\n$EndParametricNodes\n", "twice"},
    {"PartOfAFile22", with_element("1 2 4 1 1 1 2 1 2 3"), "is part 2 of a mesh that was saved in"},
    {"PartWithGhosts22", with_element("1 2 5 1 1 2 1 -2 1 2 3"), "is part 1 of a mesh"},
    {"GroupsOfParts22",
     head22 + "$PhysicalNames\n1\n1 7 \"_part{1}_physical{4}_dim{1}\"\n$EndPhysicalNames\n",
     "without partitions"},
    {"HugeGroup", with_element("1 2 2 99999999999 1 1 2 3"), "99999999999 is out of range"},
    {"FileType", "$MeshFormat\n2.2 3 8\n$EndMeshFormat\n", "file type 3"},
    {"NumberSize", "$MeshFormat\n2.2 0 4\n$EndMeshFormat\n", "numbers of 4 bytes"},
    {"BigEndian", std::string("$MeshFormat\n2.2 1 8\n\0\0\0\1\n$EndMeshFormat\n", 40),
     "not little-endian"},
    {"NoNodes", head22, "there is no $Nodes"},
    {"NoElements", head22 + nodes22, "there is no $Elements"},
    {"NoSection", head22 + "hello", "expected a section, found \"hello\""},
    {"SectionTwice", head22 + nodes22 + nodes22, "line 11, in $Nodes: the section occurs twice"},
    {"OpenSection", head22 + "$Comments\nabc\n", "there is no $EndComments"},
    {"NotANumber", head22 + "$Nodes\n1\n1 zero 0 0\n$EndNodes\n", "found \"zero\""},
    {"MoreAnnounced", head22 + "$Nodes\n1000000\n1 0 0 0\n$EndNodes\n", "announces 1000000"},
    {"NegativeCount", head22 + "$Nodes\n-1\n", "expected a number, found \"-1\""},
    {"NegativeNode", head22 + "$Nodes\n1\n-4 0 0 0\n$EndNodes\n", "node -4"},
    {"Quadrangle", with_element("1 3 2 1 1 1 2 3 4"), "4-node quadrangles; make triangles only"},
    {"SecondOrder", with_element("1 9 2 1 1 1 2 3 4 1 2"), "6-node triangles; save first-order"},
    {"SecondOrderLine", with_element("1 8 2 1 1 1 2 3"), "3-node lines; save first-order"},
    {"Tetrahedron", with_element("1 4 2 1 1 1 2 3 4"), "tetrahedra; a plane mesh"},
    {"OtherElement", with_element("1 21 2 1 1 1 2 3"), "elements of type 21"},
    {"TagCount", with_element("1 2 -3 1 1 1 2 3"), "-3 tags"},
    {"EntitiesIn22", head22 + "$Entities\n0 0 0 0\n$EndEntities\n", "no such section"},
    {"CountsDiffer41", head41 + "$Nodes\n1 3 1 3\n2 1 0 1\n1\n0 0 0\n$EndNodes\n",
     "announces 3 nodes, has 1"},
    {"SurfaceInTwoGroups",
     head41 + "$Entities\n0 0 1 0\n5 0 0 0 0 0 0 2 1 2 0\n$EndEntities\n"
              "$Nodes\n1 3 1 3\n2 5 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
              "$Elements\n1 1 1 1\n2 5 2 1\n1 1 2 3\n$EndElements\n",
     "surface 5 is in 2 physical groups"},
    {"NameWithoutMarks", head22 + "$PhysicalNames\n1\n1 1 dirichlet\n$EndPhysicalNames\n",
     "quotation marks"},
};

INSTANTIATE_TEST_SUITE_P(Msh, RefusedText, ::testing::ValuesIn(texts),
                         [](const auto& case_) { return case_.param.name; });

TEST(MshFile, NegativeGroupTakesTheCurveBackwards) {
  const auto file = mesher::read_msh(with_element("1 1 2 -7 1 3 4"), enough);
  ASSERT_EQ(file.lines.size(), 1U);
  EXPECT_EQ(file.lines[0].group, 7);
  EXPECT_EQ(file.lines[0].nodes, (std::array<std::uint64_t, 2>{4, 3}));
}

TEST(MshFile, OlderVersionsAreWrittenAs22) {
  const std::string file = write_msh(square_sample(), MshFormat::ascii22);
  const auto newer = mesher::read_msh(file, enough);
  for (const std::string version : {"2", "2.0", "2.1"}) {
    std::string old = file;
    old.replace(old.find("2.2"), 3, version);
    const auto read = mesher::read_msh(old, enough);
    EXPECT_EQ(read.xyz, newer.xyz);
    EXPECT_EQ(read.triangles.size(), newer.triangles.size());
    EXPECT_EQ(read.curve_names, newer.curve_names);
  }
}

/// 2.0 gives no dimension with a name.
TEST(MshFile, ANameWithoutDimensionIsThatOfWhatHasItsTag) {
  std::string file = with_element("1 2 3 7 1 0 1 2 3");
  file.insert(file.find("$Nodes"),
              "$PhysicalNames\n2\n7 \"inclusion\"\n9 \"glue\"\n$EndPhysicalNames\n");
  const auto read = mesher::read_msh(file, enough);
  EXPECT_EQ(read.surface_names.at(7), "inclusion");
  EXPECT_TRUE(read.curve_names.empty());
}

TEST(MshFile, ParametricNodesAreNodes) {
  const std::string nodes =
      "$ParametricNodes\n4\n1 0 0 0 0 1\n2 1 0 0 1 3 0.5\n3 1 1 0 2 1 0.5 0.5\n4 0 1 0\n"
      "$EndParametricNodes\n";
  const auto file =
      mesher::read_msh(head22 + nodes + "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n", enough);
  EXPECT_EQ(file.xyz, (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
}

TEST(MshFile, NumbersOfNodesAboveFourBytesAreRead) {
  const std::string file = head22 +
                           "$Nodes\n3\n1099511000001 0 0 +0\n1099511000002 +1.0e0 0 0\n"
                           "1099511000003 1 1 0\n$EndNodes\n$Elements\n1\n9999999999 2 2 1 1 "
                           "1099511000001 1099511000002 1099511000003\n$EndElements\n";
  EXPECT_EQ(mesher::read_msh(file, enough).triangles[0].nodes,
            (std::array<std::uint64_t, 3>{1099511000001, 1099511000002, 1099511000003}));
}

TEST_P(EachFormat, AMarkAndCommentsMayComeFirst) {
  const std::string start = "\xef\xbb\xbf\n$Comments\nby hand\n$EndComments\n";
  EXPECT_EQ(mesher::read_msh(start + bytes(), enough).triangles.size(), 32U);
}

/// What gmsh makes of a square cut in two parts: a crack with the tag of the surface's group is no
/// crack, a curve is in the group of the whole.
TEST(MshFile, PartsAreInTheGroupsOfTheWhole) {
  const auto file = mesher::read_msh(
      head41 +
          "$Entities\n0 2 1 0\n5 0 0 0 1 1 0 1 13 0\n6 0 0 0 1 1 0 0 0\n"
          "9 0 0 0 1 1 0 1 21 0\n$EndEntities\n"
          "$PartitionedEntities\n2\n1\n77 1\n0 3 2 0\n"
          "30 1 5 1 1 0 0 0 1 1 0 0 0\n31 2 9 2 1 2 0 0 0 1 1 0 1 21 0\n"
          "32 1 6 1 2 0 0 0 1 1 0 0 0\n"
          "40 2 9 1 1 0 0 0 1 1 0 1 99 0\n41 2 9 1 2 0 0 0 1 1 0 1 21 0\n"
          "$EndPartitionedEntities\n"
          "$Nodes\n1 4 1 4\n2 40 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
          "$Elements\n5 5 1 5\n1 30 1 1\n1 1 2\n1 31 1 1\n2 1 3\n1 32 1 1\n3 3 4\n"
          "2 40 2 1\n4 1 2 3\n2 41 2 1\n5 1 3 4\n$EndElements\n",
      enough);
  ASSERT_EQ(file.lines.size(), 2U);
  EXPECT_EQ(file.lines[0].group, 13);
  EXPECT_EQ(file.lines[0].entity, 5);
  EXPECT_EQ(file.lines[1].group, 0);
  EXPECT_EQ(file.lines[1].entity, 6);
  ASSERT_EQ(file.triangles.size(), 2U);
  for (const auto& triangle : file.triangles) {
    EXPECT_EQ(triangle.group, 21);
    EXPECT_EQ(triangle.entity, 9);
  }
}

TEST(MshFile, WindowsLineEndsAreRead) {
  std::string file = write_msh(square_sample(), MshFormat::ascii41);
  for (std::size_t at = 0; (at = file.find('\n', at)) != std::string::npos; at += 2) {
    file.insert(at, "\r");
  }
  EXPECT_EQ(mesher::read_msh(file, enough).triangles.size(), 32U);
}

}  // namespace
}  // namespace anticrack
