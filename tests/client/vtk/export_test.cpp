// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtk/export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "client/vtk/read_vtu.hpp"
#include "support/sample_result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::vtk {
namespace {

using anticrack::testing::sample_result;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::with_stages;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Export, writes_two_files_a_load_and_their_collection) {
  const TemporaryFolder folder;
  const results::Result result = sample_result(4);
  const Exported exported = export_result(result, "paper.h5", folder / "new");
  EXPECT_THAT(exported.files,
              ElementsAre(folder / "new/opening.vtu", folder / "new/opening-interfaces.vtu",
                          folder / "new/partly_closed.vtu",
                          folder / "new/partly_closed-interfaces.vtu", folder / "new/result.pvd"));
  EXPECT_TRUE(exported.notes.empty());
  const std::string pvd = bytes_of(folder / "new/result.pvd");
  for (const char* file : {"\"opening.vtu\"", "\"partly_closed-interfaces.vtu\""}) {
    EXPECT_THAT(pvd, HasSubstr(file));
  }
}

TEST(Export, names_units) {
  const TemporaryFolder folder;
  results::Result result = sample_result(4);
  result.units = anticrack::testing::units_of("<mm>", "N");
  export_result(result, "paper.h5", folder.path());
  const std::string file = bytes_of(folder / "opening.vtu");
  const std::string label = "<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">";
  EXPECT_THAT(file, HasSubstr(label + "&#60;mm></InformationKey>"));
  EXPECT_THAT(bytes_of(folder / "opening-interfaces.vtu"),
              HasSubstr(label + "N/&#60;mm></InformationKey>"));
}

TEST(Export, keeps_both_faces_of_the_interface) {
  const TemporaryFolder folder;
  const results::Result result = sample_result(4);  // 81 nodes, 9 of them on the interface
  export_result(result, "paper.h5", folder.path());
  const ReadVtu seen = read_vtu(bytes_of(folder / "opening.vtu"));
  EXPECT_EQ(seen.points, 90u);
  EXPECT_EQ(seen.cells, 128u);
  const auto points = seen.arrays.at("Points").as<double>();
  const auto u = seen.arrays.at("u").as<double>();
  const auto node = seen.arrays.at("node").as<std::int32_t>();
  const auto subdomain = seen.arrays.at("subdomain").as<std::int32_t>();
  const auto tension = seen.arrays.at("tension").as<double>();
  const auto corners = seen.arrays.at("connectivity").as<std::int64_t>();
  ASSERT_EQ(u.size(), 90u);
  ASSERT_EQ(corners.size(), 384u);
  for (std::size_t t = 0; t < 128; ++t) {
    const bool plus = subdomain[t] == 1;
    EXPECT_EQ(tension[t], plus ? 2 : 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto p = static_cast<std::size_t>(corners[3 * t + c]);
      EXPECT_EQ(points[3 * p], result.mesh.xy[2 * static_cast<std::size_t>(node[p])]);
      EXPECT_EQ(points[3 * p + 2], 0);
      EXPECT_DOUBLE_EQ(u[p],
                       anticrack::testing::sample_u(points[3 * p], points[3 * p + 1], plus, false));
    }
  }
}

TEST(Export, keeps_both_faces_of_a_slit) {
  results::Result result = sample_result(4);
  results::Field& field = result.loads[0].fields[1];
  field.nodes.push_back(field.nodes[4]);
  field.u.push_back(7);
  *std::find(field.triangles.begin(), field.triangles.end(), 4) =
      static_cast<std::int32_t>(field.nodes.size()) - 1;
  const UnstructuredGrid grid = membrane(result, result.loads[0]);
  EXPECT_EQ(grid.xy.size(), 2 * 91u);
  EXPECT_EQ(std::get<std::vector<double>>(grid.points[0].values).back(), 7);
  EXPECT_EQ(std::count(grid.corners.begin(), grid.corners.end(), 90), 1);
}

TEST(Export, gives_each_triangle_its_error_indicator) {
  const TemporaryFolder folder;
  results::Result result = with_stages(sample_result(4));
  result.loads[1].indicator.clear();
  // A field may have its triangles in any order, each from any corner.
  auto& triangles = result.loads[0].fields[1].triangles;
  std::reverse(triangles.begin(), triangles.end());
  for (std::size_t t = 0; t < triangles.size(); t += 3) std::swap(triangles[t], triangles[t + 2]);
  export_result(result, "paper.h5", folder.path());
  const ReadVtu seen = read_vtu(bytes_of(folder / "opening.vtu"));
  const auto indicator = seen.arrays.at("error_indicator").as<double>();
  ASSERT_EQ(indicator.size(), 128u);
  EXPECT_EQ(indicator[0], result.loads[0].indicator[0]);
  EXPECT_EQ(indicator[64], result.loads[0].indicator[127]);
  EXPECT_EQ(indicator[127], result.loads[0].indicator[64]);
  EXPECT_EQ(read_vtu(bytes_of(folder / "partly_closed.vtu")).arrays.count("error_indicator"), 0u);
}

TEST(Export, carries_traces_and_pressure_along_the_interface) {
  const TemporaryFolder folder;
  const results::Result result = sample_result(4);
  export_result(result, "paper.h5", folder.path());
  const ReadVtu seen = read_vtu(bytes_of(folder / "partly_closed-interfaces.vtu"));
  EXPECT_EQ(seen.points, 9u);
  EXPECT_EQ(seen.cells, 8u);
  const results::Trace& trace = result.loads[1].traces[0];
  EXPECT_EQ(seen.arrays.at("u_minus").as<double>(), trace.u_minus);
  EXPECT_EQ(seen.arrays.at("u_plus").as<double>(), trace.u_plus);
  EXPECT_EQ(seen.arrays.at("jump").as<double>(), trace.jump);
  EXPECT_EQ(seen.arrays.at("pressure").as<double>(), trace.pressure);
  EXPECT_EQ(seen.arrays.at("contact").as<std::int32_t>(), trace.contact);
  EXPECT_EQ(seen.arrays.at("s").as<double>(), result.interfaces[0].s);
  EXPECT_EQ(seen.arrays.at("kind").as<std::int32_t>()[4], 4);
  EXPECT_EQ(seen.arrays.at("inclusion").as<std::int32_t>(), result.interfaces[0].edge_inclusion);
  EXPECT_EQ(seen.arrays.at("types").as<std::uint8_t>(), std::vector<std::uint8_t>(8, 3));
}

TEST(Export, of_several_interfaces_joins_none) {
  results::Result result = sample_result(4);
  result.interfaces.push_back(result.interfaces[0]);
  result.loads[0].traces.push_back(result.loads[0].traces[0]);
  const UnstructuredGrid grid = interfaces(result, result.loads[0]);
  EXPECT_EQ(grid.corners.size(), 32u);
  EXPECT_EQ(grid.corners[15], 8);
  EXPECT_EQ(grid.corners[16], 9);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(grid.cells[0].values).back(), 1);
}

TEST(Export, says_how_to_get_fields) {
  const TemporaryFolder folder;
  results::Result result = sample_result(4);
  for (results::Load& load : result.loads) load.fields.clear();
  try {
    export_result(result, "paper.h5", folder / "a");
    FAIL();
  } catch (const results::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("paper.h5: load \"opening\": the result has no fields"));
    EXPECT_THAT(error.cure(), HasSubstr("anticrack job fetch " + result.job_name + " --fields -o"));
    EXPECT_THAT(error.cure(), HasSubstr("--set output.fields=true"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a"));
}

TEST(Export, passes_over_a_load_that_failed) {
  const TemporaryFolder folder;
  results::Result result = sample_result(4);
  result.loads[0].answer.set_status(v1::LoadCaseAnswer::STATUS_FAILED);
  result.loads[0].traces.clear();
  result.loads[0].fields.clear();
  const Exported exported = export_result(result, "paper.h5", folder.path());
  EXPECT_EQ(exported.files.size(), 3u);
  EXPECT_THAT(exported.notes, ElementsAre(HasSubstr("no answer (failed)")));
  result.loads.resize(1);
  EXPECT_THROW(export_result(result, "paper.h5", folder.path()), results::Error);
}

TEST(Export, refuses_a_folder_it_cannot_make) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(export_result(sample_result(2), "paper.h5", folder / "file/a"), results::Error);
}

}  // namespace
}  // namespace anticrack::vtk
