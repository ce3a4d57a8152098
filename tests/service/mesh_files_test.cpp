// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files with meshes through `anticrack run` and `sweep`: what their import warns of is said, and
// there is a result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "mesher/msh_changes.hpp"
#include "mesher/msh_writer.hpp"
#include "service/processes.hpp"

namespace anticrack::service_test {
namespace {

namespace fs = std::filesystem;
using anticrack::testing::add_lines;
using anticrack::testing::MshFormat;
using anticrack::testing::MshSample;
using anticrack::testing::square_sample;
using anticrack::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAreArray;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::Not;

/// A case on a mesh of its own.
std::string write_case(const TemporaryFolder& folder, const fs::path& mesh) {
  return write_file(folder, "case.toml",
                    "mesh.file = \"" + mesh.string() + "\"\n[[load]]\nname = \"one\"\nf = 1\n");
}

std::vector<std::string> warnings_of(const std::string& output) {
  const std::string start = "mesh: ";
  std::vector<std::string> found;
  std::istringstream stream(output);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with(start)) found.push_back(line.substr(start.size()));
  }
  return found;
}

void expect_converged(const Server& server, const std::string& file) {
  const Ended show = server.client({"show", file});
  EXPECT_EQ(show.code, 0) << show.error;
  EXPECT_THAT(show.output, HasSubstr("converged"));
}

struct Sample {
  std::string name;
  MshFormat format;
  void (*change)(MshSample& sample);  ///< of square_sample("delaminated:stiffener")
  std::vector<std::string> warnings;  ///< each is a part of what is said, in order
};

void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.name; }

class MeshFiles : public ::testing::TestWithParam<Sample> {
 protected:
  MeshFiles() {
    MshSample sample = square_sample();
    GetParam().change(sample);
    anticrack::testing::save(folder / "plate.msh", write_msh(sample, GetParam().format));
    path = write_case(folder, "plate.msh");
  }

  void expect_warnings(const std::string& output) const {
    std::vector<::testing::Matcher<std::string>> expected;
    for (const std::string& warning : GetParam().warnings) expected.push_back(HasSubstr(warning));
    EXPECT_THAT(warnings_of(output), ElementsAreArray(expected));
  }

  const Server server;
  const TemporaryFolder folder;
  const std::string file = folder / "out.h5";
  std::string path;
};

TEST_P(MeshFiles, AreRunWithWhatIsAssumedSaid) {
  const Ended run = server.client({"run", path, "-o", file});
  ASSERT_EQ(run.code, 0) << run.output << run.error;
  expect_warnings(run.output);
  expect_converged(server, file);
}

TEST_P(MeshFiles, AreSweptWithWhatIsAssumedSaid) {
  const std::string rows = write_file(folder, "rows.csv", "one\n1\n-1\n");
  const Ended sweep = server.client({"sweep", path, "--coefficients", rows, "-o", file, "--json"});
  ASSERT_EQ(sweep.code, 0) << sweep.output << sweep.error;
  expect_warnings(sweep.error);
  expect_converged(server, file);
}

INSTANTIATE_TEST_SUITE_P(
    Samples, MeshFiles,
    ::testing::Values(
        Sample{"AsTheyShallBe", MshFormat::ascii41, [](MshSample&) {}, {}},
        Sample{"Clockwise",
               MshFormat::ascii22,
               [](MshSample& sample) {
                 for (const std::size_t i : {3U, 20U}) {
                   std::swap(sample.triangles[i].nodes[0], sample.triangles[i].nodes[1]);
                 }
               },
               {"2 triangles were clockwise"}},
        Sample{"DoubledNodes",
               MshFormat::binary22,
               [](MshSample& sample) { anticrack::testing::open_middle(sample, {0}); },
               {"1 node that lies on another made one with it, as are 2 pairs"}},
        Sample{"MissingGroups",
               MshFormat::binary41,
               [](MshSample& sample) { anticrack::testing::remove_groups(sample); },
               {"the file has no physical surface", "curve 11 (in no group) lies on the boundary",
                "curve 12 (in no group) lies between two subdomains", "2 edges in no curve group"}},
        Sample{"MissingLines",
               MshFormat::ascii41,
               [](MshSample& sample) { sample.lines.erase(sample.lines.begin()); },
               {"1 edge in no curve group"}},
        Sample{"AnotherPlane",
               MshFormat::binary41,
               [](MshSample& sample) {
                 for (auto& point : sample.points) point[2] = 0.25;
               },
               {"the mesh lies at z = 0.25"}},
        Sample{"AllAtOnce",
               MshFormat::ascii22,
               [](MshSample& sample) {
                 sample.tags.push_back(999);
                 sample.points.push_back({3, 3, 0});
                 sample.lines.push_back({{10, 999}, 8, 18});
                 add_lines(sample, {{-1, -1}, {1, 1}}, 9, "diagonal");
                 std::swap(sample.triangles[3].nodes[0], sample.triangles[3].nodes[1]);
                 for (auto& point : sample.points) point[2] = -1;
               },
               {"the mesh lies at z = -1", "1 node that belongs to no triangle",
                "1 triangle was clockwise", "1 line with nodes that belong to no triangle",
                "\"diagonal\" lies on no edge"}}),
    [](const auto& tested) { return tested.param.name; });

/// Files with meshes that the tree has, the broken ones too.
std::vector<fs::path> fixtures() {
  std::vector<fs::path> found;
  for (const char* folder : {"tests", "client/examples"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(SOURCES) / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() == ".msh" || path.parent_path().filename() == "msh_file") {
        found.push_back(path);
      }
    }
  }
  return found;
}

TEST(MeshFixtures, GiveAResultOrARefusal) {
  const Server server;
  const TemporaryFolder folder;
  int results = 0;
  for (const fs::path& mesh : fixtures()) {
    SCOPED_TRACE(mesh);
    const fs::path file = folder / mesh.filename().concat(".h5");
    const Ended run = server.client({"run", write_case(folder, mesh), "-o", file.string()});
    EXPECT_THAT(run.code, AnyOf(Eq(0), Eq(1), Eq(2))) << run.output << run.error;
    EXPECT_EQ(fs::exists(file), run.code == 0) << run.output << run.error;
    if (run.code == 0) {
      expect_converged(server, file.string());
      ++results;
    } else {
      EXPECT_THAT(run.error, AllOf(HasSubstr("anticrack: "), Not(HasSubstr("Sanitizer"))));
    }
  }
  EXPECT_GE(results, 2) << "plate.msh and section-6.msh are meshes to solve on";
}

}  // namespace
}  // namespace anticrack::service_test
