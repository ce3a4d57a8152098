// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

TEST(Case, BecomesRequests) {
  const Case the_case = parse(sample_text);

  EXPECT_EQ(the_case.mesh.title(), "A plate");
  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_PAPER);
  EXPECT_FALSE(the_case.mesh_file.has_value());
  const v1::Geometry& geometry = the_case.mesh.geometry();
  ASSERT_EQ(geometry.boundary_size(), 4);
  EXPECT_EQ(geometry.boundary(1).x(), 1);
  EXPECT_EQ(geometry.boundary(1).y(), -1);
  ASSERT_EQ(geometry.interface().points_size(), 2);
  ASSERT_EQ(geometry.inclusions_size(), 1);
  EXPECT_EQ(geometry.inclusions(0).name(), "fibre");
  EXPECT_EQ(geometry.inclusions(0).part().from().x(), -0.5);
  EXPECT_EQ(geometry.inclusions(0).part().to().x(), 0.5);
  EXPECT_EQ(geometry.inclusions(0).delamination_case(), v1::Inclusion::DELAMINATION_NOT_SET);

  EXPECT_EQ(the_case.job.title(), "A plate");
  EXPECT_EQ(the_case.job.solver().uzawa().theta(), 1.5);
  EXPECT_FALSE(the_case.job.solver().uzawa().has_epsilon());
  EXPECT_FALSE(the_case.job.fields());
  ASSERT_EQ(the_case.job.load_cases_size(), 2);
  EXPECT_EQ(the_case.job.load_cases(0).name(), "one");
  EXPECT_EQ(the_case.job.load_cases(0).force().constant(), 1);
  EXPECT_EQ(the_case.job.load_cases(1).force().expression(), "y > 0 ? 1 : -1");
  EXPECT_EQ(the_case.text, sample_text);
}

TEST(Case, ReadsEveryKey) {
  const Case the_case = parse(sample_with("[solver]\ntheta = 1.5",
                                          R"(delaminated = [[[-0.5, 0], [0, 0]]]
[[geometry.crack]]
name = "slit"
from = [0.6, 0]
to = [0.7, 0]
[mesh]
preset = "uniform"
size = 0.1
[output]
fields = true
[solver]
method = "uzawa"
theta = "auto"
epsilon = 1e-10
p = 1000
max_iterations = 7
mass = "consistent")") + "boundary_value = \"-y\"\n");
  const v1::Geometry& geometry = the_case.mesh.geometry();
  ASSERT_EQ(geometry.inclusions(0).delaminated_parts().parts_size(), 1);
  EXPECT_EQ(geometry.inclusions(0).delaminated_parts().parts(0).from().x(), -0.5);
  EXPECT_EQ(geometry.inclusions(0).delaminated_parts().parts(0).to().x(), 0);
  ASSERT_EQ(geometry.cracks_size(), 1);
  EXPECT_EQ(geometry.cracks(0).name(), "slit");
  EXPECT_EQ(geometry.cracks(0).part().to().x(), 0.7);
  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_UNIFORM);
  EXPECT_EQ(the_case.mesh.options().size(), 0.1);
  EXPECT_TRUE(the_case.job.fields());
  const v1::Uzawa& uzawa = the_case.job.solver().uzawa();
  EXPECT_TRUE(uzawa.theta_auto());
  EXPECT_EQ(uzawa.epsilon(), 1e-10);
  EXPECT_EQ(uzawa.p(), 1000);
  EXPECT_EQ(uzawa.max_iterations(), 7);
  EXPECT_EQ(uzawa.mass(), v1::MASS_CONSISTENT);
  EXPECT_EQ(the_case.job.load_cases(1).boundary_value(), "-y");
}

TEST(Case, TakesForcesByRegion) {
  const Case the_case = parse(sample_with("f = 1\n", "f = {minus = -1, plus = 2.5}\n"));
  const auto& values = the_case.job.load_cases(0).force().per_region().values();
  EXPECT_EQ(values.size(), 2U);
  EXPECT_EQ(values.at("minus"), -1);
  EXPECT_EQ(values.at("plus"), 2.5);
}

TEST(Case, NeedsNoForceWhereABoundaryValueIsGiven) {
  const Case the_case = parse(sample_with("f = 1\n", "boundary_value = \"-y\"\n"));
  EXPECT_FALSE(the_case.job.load_cases(0).has_force());
  EXPECT_EQ(the_case.job.load_cases(0).boundary_value(), "-y");
}

TEST(Case, TakesAMeshFileBesideTheCase) {
  const Case the_case =
      parse_case("mesh.file = \"plate.msh\"\n[[load]]\nname = \"one\"\nf = 1\n", "some/where.toml");
  ASSERT_TRUE(the_case.mesh_file.has_value());
  EXPECT_EQ(*the_case.mesh_file, "some/plate.msh");
  EXPECT_EQ(the_case.mesh.source_case(), v1::CreateMeshRequest::SOURCE_NOT_SET);
  EXPECT_FALSE(the_case.mesh.has_options());
}

TEST(Case, PassesOnWhatTheServerMayNotKnowYet) {
  const Case the_case =
      parse(sample_with("theta = 1.5", "method = \"active-set\""), {"mesh.preset=graded"});
  EXPECT_TRUE(the_case.job.solver().has_active_set());
  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_GRADED);
}

TEST(Case, IsReadTheSameEveryTime) {
  const std::string text = sample_with("f = 1\n", "f = {a = 1, b = 2, c = 3}\n");
  const std::vector<std::string> overrides{"title=Other"};
  EXPECT_EQ(parse(text, overrides).text, parse(text, overrides).text);
  EXPECT_EQ(parse(text, overrides).mesh.SerializeAsString(),
            parse(text, overrides).mesh.SerializeAsString());
}

TEST(Locate, FindsTheLineOfAField) {
  const Case the_case = parse(sample_text);
  const auto spot = the_case.locate("job.load_cases[1].force.expression");
  ASSERT_TRUE(spot.has_value());
  EXPECT_EQ(spot->key, "load.1.f");
  EXPECT_EQ(spot->line, 20U);
  EXPECT_EQ(prefix(*spot), "plate.toml:20: load.1.f: ");
  EXPECT_EQ(the_case.locate("job.solver.uzawa.theta")->key, "solver.theta");
  EXPECT_EQ(the_case.locate("geometry.inclusions[0].part.from")->line, 9U);
  EXPECT_EQ(the_case.locate("geometry.interface.points[1]")->key, "geometry.interface");
}

TEST(Locate, FindsWhatIsAroundADefault) {
  const Case the_case = parse(sample_text);
  EXPECT_EQ(the_case.locate("job.solver.uzawa.p")->key, "solver");
  EXPECT_FALSE(the_case.locate("request_id").has_value());
  EXPECT_FALSE(the_case.locate("").has_value());
}

TEST(Locate, NamesTheOverrideThatWroteIt) {
  const Case the_case = parse(sample_text, {"solver.theta=-1"});
  EXPECT_EQ(prefix(*the_case.locate("job.solver.uzawa.theta")),
            "--set solver.theta=-1: solver.theta: ");
}

}  // namespace
}  // namespace anticrack::casefile
