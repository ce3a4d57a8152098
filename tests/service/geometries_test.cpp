// SPDX-License-Identifier: GPL-3.0-or-later
//
// The shipped cases beyond the paper's, through every command that shows them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "service/processes.hpp"

namespace anticrack::service_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::size_t count_in(const std::filesystem::path& folder, const std::string& extension) {
  return static_cast<std::size_t>(std::count_if(
      std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator(),
      [&](const auto& entry) { return entry.path().extension() == extension; }));
}

class Geometries : public ::testing::TestWithParam<std::string> {};

TEST_P(Geometries, AreSolvedDrawnAndExported) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const std::string file = folder / "out.h5";

  const Ended run = server.client({"run", example(GetParam() + ".toml"), "-o", file, "--json"});
  ASSERT_EQ(run.code, 0) << run.output << run.error;
  const auto answers = parse_json(run.output).fields().at("answers").list_value();
  ASSERT_EQ(answers.values_size(), 2);
  for (const auto& answer : answers.values()) {
    const auto& fields = answer.struct_value().fields();
    EXPECT_EQ(fields.at("status").string_value(), "converged");
    EXPECT_EQ(fields.at("method").string_value(), "active-set");
  }

  const Ended show = server.client({"show", file});
  EXPECT_EQ(show.code, 0) << show.error;
  EXPECT_THAT(show.output, HasSubstr("converged"));

  const Ended plot = server.client({"plot", file, "-o", folder / "figures"});
  ASSERT_EQ(plot.code, 0) << plot.error;
  EXPECT_GE(count_in(folder / "figures", ".png"), 4U);

  const Ended exported = server.client({"export", file, "-o", folder / "paraview"});
  ASSERT_EQ(exported.code, 0) << exported.error;
  EXPECT_EQ(count_in(folder / "paraview", ".vtu"), 4U);
  EXPECT_TRUE(std::filesystem::exists(folder / "paraview/result.pvd"));

  const Ended mesh =
      server.client({"mesh", "show", example(GetParam() + ".toml"), "-o", folder / "mesh"});
  ASSERT_EQ(mesh.code, 0) << mesh.error;
  EXPECT_THAT(mesh.output, AllOf(HasSubstr("subdomain"), HasSubstr("smallest edge"),
                                 HasSubstr("boundary: u given")));
  EXPECT_EQ(count_in(folder / "mesh", ".svg"), 1U);
  EXPECT_EQ(server.info().metrics().meshings(), 1U) << "the same definition is the same mesh";
}

INSTANTIATE_TEST_SUITE_P(Examples, Geometries,
                         ::testing::Values("several-inclusions", "slit", "arc", "floating"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Floating, IsRefusedByUzawaWithTheCure) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const Ended run = server.client(
      {"run", example("floating.toml"), "-o", folder / "out.h5", "--set", "solver.method=uzawa"});
  EXPECT_NE(run.code, 0) << run.output;
  EXPECT_THAT(run.error, AllOf(HasSubstr("patch"), ::testing::ContainsRegex("active.set")));
}

class ForceFile : public ::testing::Test {
 protected:
  /// A membrane without cracks; its own u, of one value a node, is the file of forces.
  Ended run(const std::string& force, const std::string& output) {
    const std::string text =
        "[geometry]\nboundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n[output]\nfields = true\n"
        "[[load]]\nname = \"one\"\nf = " +
        force + "\n";
    const std::string path = write_file(folder, "plain.toml", text);
    return server.client({"run", path, "-o", folder / output});
  }

  const Server server;
  const anticrack::testing::TemporaryFolder folder;
};

TEST_F(ForceFile, OfOneValueANodeIsUploadedAndUsed) {
  ASSERT_EQ(run("1", "first.h5").code, 0);
  const Ended second = run(
      "{file = \"first.h5\", dataset = \"/loads/one/fields/0/u\", per = \"node\"}", "second.h5");
  EXPECT_EQ(second.code, 0) << second.error;
}

TEST_F(ForceFile, OfAnotherLengthIsRefused) {
  ASSERT_EQ(run("1", "first.h5").code, 0);
  const Ended second =
      run("{file = \"first.h5\", dataset = \"/loads/one/fields/0/u\", per = \"triangle\"}",
          "second.h5");
  EXPECT_NE(second.code, 0) << second.output;
  EXPECT_THAT(second.error, HasSubstr("triangle"));
}

TEST_F(ForceFile, ThatIsMissingNamesTheLine) {
  const Ended missing = run("{file = \"no.h5\", dataset = \"/f\", per = \"node\"}", "out.h5");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.error, AllOf(HasSubstr("plain.toml:7: load.one.f"), HasSubstr("no.h5")));
  EXPECT_EQ(server.info().metrics().meshings(), 0U) << "seen before anything was asked for";
}

}  // namespace
}  // namespace anticrack::service_test
