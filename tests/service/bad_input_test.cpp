// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bad input: a clear error that names the field, and a server that serves on. The tables of
// tests/client/cli/wrong_cases.py and wrong_commands.py have the words for every mistake.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "service/processes.hpp"

namespace anticrack::service_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int any_error = -1;

struct BadCase {
  std::string name;
  std::vector<std::string> overrides;  ///< of paper-3.toml
  std::vector<std::string> says;       ///< what the error must contain
  int code = 2;                        ///< any_error: seen now or once the mesh is known
};

void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.name; }

class BadInput : public ::testing::TestWithParam<BadCase> {};

void expect_still_serving(const Server& server) {
  EXPECT_EQ(server.client({"server"}).code, 0) << server.client({"server"}).error;
}

TEST_P(BadInput, IsRefusedWithTheFieldNamed) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  std::vector<std::string> arguments = {"run", example("paper-3.toml"), "-o", folder / "out.h5"};
  for (const std::string& entry : GetParam().overrides) {
    arguments.insert(arguments.end(), {"--set", entry});
  }
  const Ended run = server.client(arguments);
  if (GetParam().code == any_error) {
    EXPECT_TRUE(run.code == 1 || run.code == 2) << run.code << run.output << run.error;
  } else {
    EXPECT_EQ(run.code, GetParam().code) << run.output << run.error;
  }
  for (const std::string& text : GetParam().says) EXPECT_THAT(run.error, HasSubstr(text));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.h5"));
  expect_still_serving(server);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadInput,
    ::testing::Values(
        BadCase{"SyntaxError", {"load.0.f='x +* 2'"}, {"expression", "x +* 2"}},
        BadCase{"UnknownSymbol", {"load.0.f='x + z'"}, {"expression", "z"}},
        BadCase{
            "NanValue", {"load.0.f='sqrt(-1 - x*x)'"}, {"expression", "nan", "must be finite"}, 1},
        BadCase{"SelfCrossingBoundary",
                {"geometry.boundary=[[-1,-1],[1,1],[1,-1],[-1,1]]"},
                {"boundary"}},
        BadCase{"InclusionOffTheInterface",
                {"geometry.inclusion.0.from=[-0.5,0.25]"},
                {"inclusion", "interface"}},
        BadCase{"InterfaceThatDoesNotCut",
                {"geometry.interface=[[-1,0],[0.9,0]]"},
                {"mesh.preset", "cuts the polygon"}},
        BadCase{"KktToleranceZero", {"solver.kkt_tolerance=0"}, {"kkt_tolerance", "0"}},
        BadCase{"GradingAboveOne", {"mesh.preset=graded", "mesh.grading=2"}, {"grading", "2"}},
        BadCase{"AlignOutside",
                {"mesh.preset=graded", "mesh.align=[[[0, 0.5], [0, 5]]]"},
                {"mesh.align"}},
        BadCase{"NeumannOffTheBoundary", {"geometry.neumann=[[[0,0],[1,1]]]"}, {"neumann"}},
        BadCase{"RegionOutside",
                {"geometry.region.0.name=top", "geometry.region.0.at=[5,5]"},
                {"region"},
                any_error},
        BadCase{
            "ContactOnAnInclusion", {"geometry.inclusion.0.contact=false"}, {"contact", "crack"}},
        BadCase{"InterfacesAlongEachOther",
                {"mesh.preset=graded",
                 "geometry.interface=[{points=[[-1,0],[1,0]]},{points=[[0,0],[1,0]]}]"},
                {"interface"}},
        BadCase{"ArcThroughALine",
                {"mesh.preset=graded", "geometry.interface=[{arc=[[-1,0],[0,0],[1,0]]}]"},
                {"interface"}},
        BadCase{"TractionSyntax",
                {"geometry.neumann=[[[1,-1],[1,1]]]", "load.0.traction='x +* 2'"},
                {"x +* 2"}},
        BadCase{
            "PointForceOutside", {"load.0.point_forces=[{at=[3,3],value=1}]"}, {"3"}, any_error},
        BadCase{"InclusionForceOnNone", {"load.0.inclusion_forces={rod=1}"}, {"rod"}, any_error}),
    [](const auto& tested) { return tested.param.name; });

TEST(BadInputFile, DuplicateLoadName) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const std::string text = read_file(example("paper-3.toml"));
  const std::string load = text.substr(text.find("[[load]]"));
  const Ended run = server.client({"run", write_file(folder, "twice.toml", text + "\n" + load)});
  EXPECT_EQ(run.code, 2) << run.output;
  EXPECT_THAT(run.error, AllOf(HasSubstr("twice"), HasSubstr("name")));
  expect_still_serving(server);
}

TEST(BadInputFile, MotionOfAnInclusionThatTheFileLacks) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const std::string path = write_file(folder, "plate.toml",
                                      "mesh.file = '" + example("plate.msh") +
                                          "'\n[[load]]\nname = \"one\"\nf = 1\n"
                                          "[mesh.inclusions]\nrod = { tilt = true }\n");
  const Ended run = server.client({"run", path, "-o", folder / "out.h5"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.error, AllOf(HasSubstr("plate.toml:6: mesh.inclusions.rod: "),
                               HasSubstr("\"rod\" is not an inclusion of the file; they are "
                                         "\"fibre\"")));
  expect_still_serving(server);
}

TEST(BadInputFile, MeshOverTheLimit) {
  const Server server({"--mesh-triangles", "1000"});
  const anticrack::testing::TemporaryFolder folder;
  const Ended run = server.client({"run", example("paper-3.toml"), "-o", folder / "out.h5"});
  EXPECT_NE(run.code, 0);
  EXPECT_THAT(run.error, HasSubstr("1000"));
  expect_still_serving(server);
}

TEST(BadInputFile, UnwritableOutputIsSeenBeforeAnythingIsSubmitted) {
  const Server server;
  const Ended run =
      server.client({"run", example("paper-3.toml"), "-o", "/nonexistent-folder/out.h5"});
  EXPECT_EQ(run.code, 2) << run.error;
  EXPECT_THAT(run.error, HasSubstr("/nonexistent-folder"));
  EXPECT_EQ(server.info().metrics().jobs_created(), 0U);
}

class BadMsh : public ::testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(BadMsh, IsRefused) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  std::string content = GetParam().second;
  const std::string here = "@FOLDER@";
  if (const auto at = content.find(here); at != std::string::npos) {
    content.replace(at, here.size(), folder.path());
  }
  const std::string path = write_file(folder, "plate.msh", content);
  const Ended upload = server.client({"mesh", "upload", path});
  EXPECT_NE(upload.code, 0) << upload.output;
  EXPECT_FALSE(upload.error.empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "evil")) << "a script was run";
  expect_still_serving(server);
}

const std::string msh_start = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";

INSTANTIATE_TEST_SUITE_P(
    Files, BadMsh,
    ::testing::Values(
        std::pair{"Empty", ""}, std::pair{"Truncated", msh_start + "$Nodes\n4\n1 0 0 0\n2 1 0 0\n"},
        std::pair{"BinaryGarbage", msh_start + std::string(4096, '\xfe')},
        std::pair{"NonTriangular", msh_start +
                                       "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
                                       "$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n"},
        std::pair{"GeoScript", "SystemCall \"touch @FOLDER@/evil\";\nPoint(1) = {0,0,0};\n"}),
    [](const auto& tested) { return tested.param.first; });

}  // namespace
}  // namespace anticrack::service_test
