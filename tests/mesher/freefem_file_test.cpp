// SPDX-License-Identifier: GPL-3.0-or-later
//
// Meshes as FreeFEM's savemesh writes them.
#include "mesher/freefem_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "mesher/import_samples.hpp"
#include "support/errors.hpp"

namespace anticrack {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

constexpr std::size_t many = 1000;

/// The sample without its names, as labels.
std::string as_freefem(const testing::MshSample& sample) {
  std::map<int, std::size_t> number;
  std::string text =
      fmt::format("{} {} {}\n", sample.tags.size(), sample.triangles.size(), sample.lines.size());
  for (std::size_t i = 0; i < sample.tags.size(); ++i) {
    number[sample.tags[i]] = i + 1;
    text += fmt::format("{} {} 0\n", sample.points[i][0], sample.points[i][1]);
  }
  for (const auto& t : sample.triangles)
    text += fmt::format("{} {} {} {}\n", number[t.nodes[0]], number[t.nodes[1]], number[t.nodes[2]],
                        t.group);
  for (const auto& l : sample.lines)
    text += fmt::format("{} {} {}\n", number[l.nodes[0]], number[l.nodes[1]], l.group);
  return text;
}

/// The same as FreeFEM writes .mesh.
std::string as_medit(const testing::MshSample& sample) {
  const std::string plain = as_freefem(sample);
  const std::size_t vertices = sample.tags.size();
  const std::size_t triangles = sample.triangles.size();
  std::string text =
      "MeshVersionFormatted 1\n\nDimension\n2\n\nIdentifier\n\";6, Date: 26\"\n\nGeometry\n"
      "\"fg.mesh.gmsh\"\n\nVertices\n" +
      std::to_string(vertices) + "\n";
  std::size_t at = plain.find('\n') + 1;
  const auto take = [&](std::size_t lines) {
    std::string taken;
    for (; lines > 0; --lines) {
      const std::size_t end = plain.find('\n', at) + 1;
      taken += plain.substr(at, end - at);
      at = end;
    }
    return taken;
  };
  text += take(vertices);
  const std::string faces = take(triangles);
  text += fmt::format("\nEdges\n{}\n{}\n", sample.lines.size(), take(sample.lines.size()));
  text += fmt::format("\nTriangles\n{}\n{}", triangles, faces);
  return text + "\nSubDomainFromMesh\n2\n3 1 1 0\n1 1 1 0\n\nVertexOnGeometricEdge\n0\n\nEnd\n";
}

mesh::Mesh imported(const std::string& file) {
  mesh::MeshOptions options;
  options.curve_groups = {{3, "dirichlet"}, {4, "delaminated:stiffener"}};
  options.surface_groups = {{1, "minus"}, {2, "plus"}};
  return mesher::import_msh(file, options, many);
}

TEST(FreefemFile, IsTheMeshOfAMshWithTheSameGroups) {
  const testing::MshSample sample = testing::square_sample();
  const mesh::Mesh expected = testing::import_sample(sample);
  for (const std::string& file :
       {as_freefem(sample), as_medit(sample), "\xef\xbb\xbf" + as_freefem(sample)}) {
    const mesh::Mesh mesh = imported(file);
    EXPECT_EQ(mesh.xy, expected.xy);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    EXPECT_EQ(mesh.subdomain, expected.subdomain);
    EXPECT_EQ(mesh.subdomains, expected.subdomains);
    EXPECT_EQ(mesh.dirichlet, expected.dirichlet);
    ASSERT_EQ(mesh.interfaces.size(), 1U);
    EXPECT_EQ(mesh.interfaces[0].nodes, expected.interfaces[0].nodes);
    EXPECT_EQ(mesh.interfaces[0].kind, expected.interfaces[0].kind);
    EXPECT_EQ(mesh.inclusions, expected.inclusions);
  }
}

TEST(FreefemFile, LabelsOfTrianglesAreSurfacesAlsoZero) {
  testing::MshSample sample = testing::square_sample();
  for (auto& t : sample.triangles) t.group -= 1;
  EXPECT_THAT(mesher::import_msh(as_freefem(sample), {}, many).subdomains,
              UnorderedElementsAre("0", "1"));
}

TEST(FreefemFile, DamageIsRefusedOrReadAndNothingElse) {
  for (const std::string& sound :
       {as_freefem(testing::square_sample()), as_medit(testing::square_sample())}) {
    EXPECT_TRUE(testing::throws([&] { imported(sound.substr(0, sound.size() / 2)); },
                                errors::Reason::mesh_invalid));
    std::mt19937 random(3);
    for (int round = 0; round < 500; ++round) {
      std::string file = sound;
      for (int hits = 0; hits < 3; ++hits)
        file[random() % file.size()] = static_cast<char>(random() % 256);
      testing::error_of([&] { mesher::import_msh(file, {}, many); });
    }
    EXPECT_TRUE(testing::throws([&] { mesher::import_msh(sound, {}, 31); },
                                errors::Reason::limit_exceeded));
  }
}

struct Wrong {
  const char* file;
  const char* says;
};

TEST(FreefemFile, SaysWhatIsWrong) {
  for (const auto& [file, says] :
       {Wrong{"3 1 1\n0 0 0\n1 0 0\n0 1 0\n1 2 3 -4\n1 2 1\n", "label -4"},
        Wrong{"3 1 0\n0 0 0\n1 0 0\n0 1 0\n1 2 3 0\nmore\n", "more follows"},
        Wrong{"9 1 0\n0 0 0\n", "announces 9 entries"},
        Wrong{"3 1 0\n0 nan 0\n1 0 0\n0 1 0\n1 2 3 0\n", "vertex 1 is not a finite number"},
        Wrong{"MeshVersionFormatted 2\nDimension 3\nVertices 0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n",
              "Tetrahedra are not read"},
        Wrong{"MeshVersionFormatted 2\nDimension 7\n", "7 dimensions"},
        Wrong{"MeshVersionFormatted 2\nDimension 2\nEnd\n", "no triangle"}}) {
    const auto error = testing::error_of([&, text = file] { mesher::import_msh(text, {}, many); });
    ASSERT_TRUE(error) << file;
    EXPECT_EQ(error->reason(), errors::Reason::mesh_invalid);
    EXPECT_THAT(error->what(), HasSubstr(says));
  }
}

}  // namespace
}  // namespace anticrack
