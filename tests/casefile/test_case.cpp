// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

TEST(Case, BecomesRequests) {
  const Case the_case = parse(sample_text);

  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_GRADED);
  EXPECT_EQ(the_case.mesh.options().size(), 0);
  EXPECT_FALSE(the_case.mesh_file.has_value());
  const v1::Geometry& geometry = the_case.mesh.geometry();
  ASSERT_EQ(geometry.boundary_size(), 4);
  EXPECT_EQ(geometry.boundary(1).x(), 1);
  EXPECT_EQ(geometry.boundary(1).y(), -1);
  ASSERT_EQ(geometry.interfaces_size(), 1);
  EXPECT_EQ(geometry.interfaces(0).name(), "");
  ASSERT_EQ(geometry.interfaces(0).polyline().points_size(), 2);
  ASSERT_EQ(geometry.inclusions_size(), 1);
  EXPECT_EQ(geometry.inclusions(0).name(), "fibre");
  EXPECT_EQ(geometry.inclusions(0).part().from().x(), -0.5);
  EXPECT_EQ(geometry.inclusions(0).part().to().x(), 0.5);
  EXPECT_EQ(geometry.inclusions(0).delamination_case(), v1::Inclusion::DELAMINATION_NOT_SET);

  EXPECT_EQ(the_case.spec.title(), "A plate");
  EXPECT_EQ(the_case.spec.solver().uzawa().theta(), 1.5);
  EXPECT_FALSE(the_case.spec.solver().uzawa().has_epsilon());
  EXPECT_TRUE(the_case.spec.outputs().empty());
  ASSERT_EQ(the_case.spec.load_cases_size(), 2);
  EXPECT_EQ(the_case.spec.load_cases(0).name(), "one");
  EXPECT_EQ(the_case.spec.load_cases(0).force().constant(), 1);
  EXPECT_EQ(the_case.spec.load_cases(1).force().expression(), "y > 0 ? 1 : -1");
  EXPECT_EQ(the_case.text, sample_text);
}

TEST(Case, ReadsEveryKey) {
  const Case the_case = parse(sample_with("[solver]\ntheta = 1.5\nmethod = \"uzawa\"",
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
mass = "consistent"
kkt_tolerance = 1e-9)") + "boundary_value = \"-y\"\n");
  const v1::Geometry& geometry = the_case.mesh.geometry();
  ASSERT_EQ(geometry.inclusions(0).delaminated_parts().parts_size(), 1);
  EXPECT_EQ(geometry.inclusions(0).delaminated_parts().parts(0).from().x(), -0.5);
  EXPECT_EQ(geometry.inclusions(0).delaminated_parts().parts(0).to().x(), 0);
  ASSERT_EQ(geometry.cracks_size(), 1);
  EXPECT_EQ(geometry.cracks(0).name(), "slit");
  EXPECT_EQ(geometry.cracks(0).part().to().x(), 0.7);
  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_UNIFORM);
  EXPECT_EQ(the_case.mesh.options().size(), 0.1);
  EXPECT_EQ(the_case.spec.outputs(0), v1::OUTPUT_FIELDS);
  const v1::Uzawa& uzawa = the_case.spec.solver().uzawa();
  EXPECT_TRUE(uzawa.theta_auto());
  EXPECT_EQ(uzawa.epsilon(), 1e-10);
  EXPECT_EQ(uzawa.p(), 1000);
  EXPECT_EQ(uzawa.max_iterations(), 7);
  EXPECT_EQ(uzawa.mass(), v1::MASS_CONSISTENT);
  EXPECT_EQ(uzawa.kkt_tolerance(), 1e-9);
  EXPECT_EQ(the_case.spec.load_cases(1).boundary_value(), "-y");
}

TEST(Case, TakesForcesByRegion) {
  const Case the_case = parse(sample_with("f = 1\n", "f = {omega1 = -1, omega2 = 2.5}\n"));
  const auto& values = the_case.spec.load_cases(0).force().per_region().values();
  EXPECT_EQ(values.size(), 2U);
  EXPECT_EQ(values.at("omega1"), -1);
  EXPECT_EQ(values.at("omega2"), 2.5);
}

TEST(Case, NeedsNoForceWhereABoundaryValueIsGiven) {
  const Case the_case = parse(sample_with("f = 1\n", "boundary_value = \"-y\"\n"));
  EXPECT_FALSE(the_case.spec.load_cases(0).has_force());
  EXPECT_EQ(the_case.spec.load_cases(0).boundary_value(), "-y");
}

TEST(Case, TakesAMeshFileBesideTheCase) {
  const Case the_case =
      parse_case("mesh.file = \"plate.msh\"\n[[load]]\nname = \"one\"\nf = 1\n", "some/where.toml");
  ASSERT_TRUE(the_case.mesh_file.has_value());
  EXPECT_EQ(*the_case.mesh_file, "plate.msh");
  EXPECT_EQ(the_case.mesh.source_case(), v1::CreateMeshRequest::SOURCE_NOT_SET);
  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_GRADED);
}

TEST(Case, TakesTheMeaningOfAFilesGroups) {
  const Case the_case = parse_case(R"([mesh]
file = "plate.msh"
preset = "uniform"
[mesh.groups]
curve.7 = "crack:slit"
surface.1 = "top"
curve.8 = "neumann"
[mesh.tension]
top = 2.5
bottom = { along = 2, across = "1 + x", angle = 30 }
[mesh.inclusions]
rod = { tilt = true }
bar.fixed = -0.5
[[load]]
name = "one"
f = 1
)",
                                   "some/where.toml", {"mesh.groups.curve.9=glue"});
  const v1::MeshOptions& options = the_case.mesh.options();
  EXPECT_EQ(options.preset(), v1::MESH_PRESET_UNIFORM);
  EXPECT_EQ(options.curve_groups().at(7), "crack:slit");
  EXPECT_EQ(options.curve_groups().at(8), "neumann");
  EXPECT_EQ(options.curve_groups().at(9), "glue");
  EXPECT_EQ(options.surface_groups().at(1), "top");
  EXPECT_EQ(options.tension().at("top"), 2.5);
  EXPECT_EQ(locate(the_case, "options.curve_groups[7]")->line, 5U);
  EXPECT_EQ(locate(the_case, "options.curve_groups[12]")->key, "mesh.groups.curve");
  EXPECT_EQ(locate(the_case, "options.tension.top")->line, 9U);
  EXPECT_FALSE(options.tension().contains("bottom"));
  EXPECT_EQ(options.tension_laws().at("bottom").along(), "2");
  EXPECT_EQ(options.tension_laws().at("bottom").across(), "1 + x");
  EXPECT_EQ(options.tension_laws().at("bottom").angle(), 30);
  EXPECT_EQ(locate(the_case, "options.tension_laws[bottom].across")->line, 10U);
  EXPECT_TRUE(options.inclusion_motions().at("rod").tilt());
  EXPECT_FALSE(options.inclusion_motions().at("rod").has_fixed());
  EXPECT_EQ(options.inclusion_motions().at("bar").fixed(), -0.5);
  EXPECT_EQ(locate(the_case, "options.inclusion_motions[rod]")->line, 12U);
  EXPECT_EQ(locate(the_case, "mesh.options.inclusion_motions[rod]")->key, "mesh.inclusions.rod");
}

TEST(Case, TakesAFileWithoutACase) {
  const Case the_case =
      mesh_file_case("a/plate.msh", {"mesh.preset=uniform", "mesh.groups.curve.7=glue"});
  EXPECT_EQ(*the_case.mesh_file, "a/plate.msh");
  EXPECT_EQ(the_case.mesh.options().preset(), v1::MESH_PRESET_UNIFORM);
  EXPECT_EQ(the_case.mesh.options().curve_groups().at(7), "glue");
  EXPECT_EQ(mesh_file_case("plate.msh").mesh.options().preset(), v1::MESH_PRESET_GRADED);
  EXPECT_THROW(mesh_file_case("plate.msh", {"solver.theta=1"}), Error);
  EXPECT_THROW(mesh_file_case("plate.msh", {"mesh.file=other.msh"}), Error);
}

TEST(Case, TakesInterfacesOfEveryShape) {
  const Case the_case = parse(sample_with("interface = [[-1, 0], [1, 0]]\n", R"(neumann = "all"
[[geometry.interface]]
name = "ring"
spline = [[0.2, 0], [0, 0.2], [-0.2, 0]]
closed = true
[[geometry.interface]]
arc = [[-1, 0], [0, 0.5], [1, 0]]
[[geometry.interface]]
points = [[0, -1], [0, -0.5]]
[[geometry.region]]
name = "top"
at = [0, 0.9]
tension = 3
[[geometry.region]]
name = "bottom"
at = [0, -0.9]
[[geometry.region]]
name = "inside"
at = [0, 0]
tension = "1 + x^2"
)"));
  const v1::Geometry& geometry = the_case.mesh.geometry();
  ASSERT_EQ(geometry.interfaces_size(), 3);
  EXPECT_EQ(geometry.interfaces(0).name(), "ring");
  EXPECT_TRUE(geometry.interfaces(0).closed());
  EXPECT_EQ(geometry.interfaces(0).spline().points(2).x(), -0.2);
  EXPECT_EQ(geometry.interfaces(1).arc().through().y(), 0.5);
  EXPECT_EQ(geometry.interfaces(2).polyline().points(1).y(), -0.5);
  ASSERT_EQ(geometry.neumann_size(), 1);
  EXPECT_EQ(geometry.neumann(0).from().x(), geometry.neumann(0).to().x());
  ASSERT_EQ(geometry.regions_size(), 3);
  EXPECT_EQ(geometry.regions(0).tension(), 3);
  EXPECT_EQ(geometry.regions(1).tension(), 0);
  EXPECT_EQ(locate(the_case, "geometry.interfaces[0].spline.points[1]")->line, 8U);
  EXPECT_EQ(locate(the_case, "geometry.interfaces[1].arc.through")->line, 11U);
  EXPECT_EQ(locate(the_case, "geometry.interfaces[2]")->line, 12U);
  EXPECT_FALSE(geometry.regions(2).has_tension());
  EXPECT_EQ(geometry.regions(2).tension_law().along(), "1 + x^2");
  EXPECT_EQ(locate(the_case, "geometry.regions[0].tension")->line, 17U);
  EXPECT_EQ(locate(the_case, "geometry.regions[2].tension_law.along")->key,
            "geometry.region.inside.tension");
  EXPECT_EQ(locate(the_case, "geometry.neumann[0].from")->key, "geometry.neumann");
}

TEST(Case, TakesHowInclusionsMoveAndWhetherCracksTouch) {
  const std::string from = "from = [-0.5, 0]\n";
  const std::string cracks =
      "[[geometry.crack]]\nname = \"a\"\nfrom = [0.6, 0]\nto = [0.7, 0]\n"
      "[[geometry.crack]]\nname = \"b\"\nfrom = [0.8, 0]\nto = [0.9, 0]\ncontact = false\n";
  const Case held = parse(sample_with(from, from + "fixed = 0.1\n"));
  EXPECT_EQ(held.mesh.geometry().inclusions(0).fixed(), 0.1);
  EXPECT_FALSE(held.mesh.geometry().inclusions(0).tilt());
  EXPECT_EQ(locate(held, "geometry.inclusions[0].fixed")->line, 10U);
  const Case tilting = parse(sample_with("[solver]\n", cracks + "[solver]\n"),
                             {"geometry.inclusion.fibre.tilt=true"});
  EXPECT_TRUE(tilting.mesh.geometry().inclusions(0).tilt());
  EXPECT_FALSE(tilting.mesh.geometry().inclusions(0).has_fixed());
  EXPECT_FALSE(tilting.mesh.geometry().cracks(0).has_contact());
  EXPECT_TRUE(tilting.mesh.geometry().cracks(1).has_contact());
  EXPECT_FALSE(tilting.mesh.geometry().cracks(1).contact());
}

TEST(Case, NotesARegionThatForgetsItsTension) {
  const auto notes = [](const std::string& tension) {
    return parse(sample_with("[solver]\n",
                             "[[geometry.region]]\nname = \"a\"\nat = [0, 0.5]\n"
                             "[[geometry.region]]\nname = \"b\"\nat = [0, -0.5]\n" +
                                 tension + "[solver]\n"))
        .notes;
  };
  EXPECT_THAT(notes(""), ::testing::IsEmpty()) << "none gives one";
  const std::string more = "[[geometry.region]]\nname = \"c\"\nat = [0, 0.7]\n";
  EXPECT_THAT(notes("tension = 2\n" + more),
              ::testing::ElementsAre(::testing::HasSubstr("a: it and 1 more give no tension")));
  for (const char* tension : {"tension = 1\n", "tension = \"1 + x\"\n"}) {
    EXPECT_THAT(notes(tension),
                ::testing::ElementsAre(
                    "plate.toml:12: geometry.region.a: it gives no tension, though other regions "
                    "do, so its tension is 1; write tension = 1 where that is meant"));
  }
}

TEST(Case, NotesUnitsWithoutAnyTension) {
  const std::string units = "[units]\nlength = \"mm\"\nforce = \"N\"\n";
  const auto notes = [&](const std::string& more, const std::string& given) {
    return parse(sample_with("[solver]\n", more + given + "[solver]\n")).notes;
  };
  const std::string region = "[[geometry.region]]\nname = \"a\"\nat = [0, 0.5]\n";
  for (const std::string& more : {std::string(), region}) {
    EXPECT_THAT(notes(more, units),
                ::testing::ElementsAre(::testing::EndsWith(
                    ": units: nothing gives a tension, so T is 1 N/mm; write tension in "
                    "[[geometry.region]]")));
    EXPECT_THAT(notes(more, "[units]\nlength = \"mm\"\n"), ::testing::IsEmpty());
    EXPECT_THAT(notes(more, ""), ::testing::IsEmpty());
  }
  EXPECT_THAT(notes(region + "tension = 1\n", units), ::testing::IsEmpty());
  const std::string file = "mesh.file = \"x.msh\"\n", load = "[[load]]\nname = \"a\"\nf = 1\n";
  EXPECT_THAT(parse(file + units + load).notes,
              ::testing::ElementsAre(::testing::EndsWith("write [mesh.tension]")));
  EXPECT_THAT(parse(file + "mesh.tension = {a = 1}\n" + units + load).notes, ::testing::IsEmpty());
}

TEST(Case, NeedsNoInterface) {
  const Case the_case = parse_case(
      "geometry.boundary = [[0, 0], [1, 0], [0, 1]]\ngeometry.neumann = [[[0, 0], [1, 0]]]\n"
      "[[load]]\nname = \"one\"\nf = 1\n",
      "plate.toml");
  EXPECT_EQ(the_case.mesh.geometry().interfaces_size(), 0);
  EXPECT_EQ(the_case.mesh.geometry().neumann(0).to().x(), 1);
}

TEST(Case, TakesEveryKindOfLoad) {
  const Case the_case =
      parse(sample_with("f = 1\n", R"(traction = 0.5
boundary_value = "-y"
point_forces = [{at = [0.5, 0.25], value = -2}, {at = [0, 0.5], value = 1}]
inclusion_forces = {fibre = 2}
inclusion_moments = {fibre = [0.5, -0.25]}
)"),
            {"geometry.neumann=[\"side-1\"]", "geometry.inclusion.fibre.tilt=true"});
  const v1::LoadCase& load = the_case.spec.load_cases(0);
  EXPECT_FALSE(load.has_force());
  EXPECT_EQ(load.traction(), "0.5");
  EXPECT_EQ(load.boundary_value(), "-y");
  ASSERT_EQ(load.point_forces_size(), 2);
  EXPECT_EQ(load.point_forces(0).at().y(), 0.25);
  EXPECT_EQ(load.point_forces(0).value(), -2);
  EXPECT_EQ(load.inclusion_forces().at("fibre"), 2);
  EXPECT_EQ(load.inclusion_moments().at("fibre").x(), 0.5);
  EXPECT_EQ(load.inclusion_moments().at("fibre").y(), -0.25);
  EXPECT_EQ(locate(the_case, "spec.load_cases[0].point_forces[1].at")->line, 19U);
  EXPECT_EQ(locate(the_case, "spec.load_cases[0].inclusion_forces[fibre]")->key,
            "load.one.inclusion_forces.fibre");
  EXPECT_EQ(locate(the_case, "spec.load_cases[0].inclusion_moments[fibre]")->line, 21U);
  EXPECT_EQ(locate(the_case, "spec.load_cases[0].traction")->line, 17U);
}

TEST(Case, NamesTheFilesOfForces) {
  const Case the_case =
      parse_case(sample_with("f = \"y > 0 ? 1 : -1\"\n",
                             "f = {file = \"f.h5\", dataset = \"/a/f\", per = \"triangle\"}\n"),
                 "some/plate.toml");
  ASSERT_EQ(the_case.force_files.size(), 1U);
  const ForceFile& file = the_case.force_files[0];
  EXPECT_EQ(file.load_case, 1);
  EXPECT_EQ(file.path, "f.h5");
  EXPECT_EQ(file.dataset, "/a/f");
  EXPECT_TRUE(the_case.spec.load_cases(1).force().array().per_triangle());
  EXPECT_EQ(locate(the_case, "spec.load_cases[1].force.array.upload")->line, 20U);
}

TEST(Case, SolvesByTheActiveSetUnlessSaidOtherwise) {
  const std::string solver = "[solver]\ntheta = 1.5\nmethod = \"uzawa\"\n";
  EXPECT_TRUE(parse(sample_with(solver, "")).spec.solver().has_active_set());
  const Case the_case = parse(sample_with(solver, "[solver]\ntolerance = 0\nmax_steps = 7\n"));
  const v1::ActiveSet& active_set = the_case.spec.solver().active_set();
  EXPECT_TRUE(active_set.has_tolerance());
  EXPECT_EQ(active_set.tolerance(), 0);
  EXPECT_EQ(active_set.max_steps(), 7);
  EXPECT_EQ(locate(the_case, "spec.solver.active_set.max_steps")->line, 14U);
}

TEST(Case, TakesTheOptionsOfAMesh) {
  const Case the_case =
      parse(sample_text, {"mesh.size=0.1", "mesh.tip_size=1e-9", "mesh.grading=0.5",
                          "mesh.chord_angle=5", "mesh.align=[[[0, 0], [0, 0.5]]]"});
  const v1::MeshOptions& options = the_case.mesh.options();
  EXPECT_EQ(options.preset(), v1::MESH_PRESET_GRADED);
  EXPECT_EQ(options.size(), 0.1);
  EXPECT_EQ(options.tip_size(), 1e-9);
  EXPECT_EQ(options.grading(), 0.5);
  EXPECT_EQ(options.chord_angle(), 5);
  ASSERT_EQ(options.align_size(), 1);
  EXPECT_EQ(options.align(0).points(1).y(), 0.5);
}

TEST(Case, IsReadTheSameEveryTime) {
  const std::string text = sample_with("f = 1\n", "f = {omega1 = 1, omega2 = 2, omega3 = 3}\n");
  const std::vector<std::string> overrides{"title=Other"};
  EXPECT_EQ(parse(text, overrides).text, parse(text, overrides).text);
  EXPECT_EQ(parse(text, overrides).mesh.SerializeAsString(),
            parse(text, overrides).mesh.SerializeAsString());
}

TEST(Locate, FindsTheLineOfAField) {
  const Case the_case = parse(sample_text);
  const auto spot = locate(the_case, "spec.load_cases[1].force.expression");
  ASSERT_TRUE(spot != nullptr);
  EXPECT_EQ(spot->key, "load.two.f");
  EXPECT_EQ(spot->line, 20U);
  EXPECT_EQ(prefix(*spot), "plate.toml:20: load.two.f: ");
  EXPECT_EQ(locate(the_case, "spec.solver.uzawa.theta")->key, "solver.theta");
  EXPECT_EQ(locate(the_case, "geometry.inclusions[0].part.from")->line, 9U);
  EXPECT_EQ(locate(the_case, "geometry.interfaces[0].polyline.points[1]")->key,
            "geometry.interface.1");
  EXPECT_EQ(locate(the_case, "geometry.interfaces[0].name")->key, "geometry.interface");
  EXPECT_EQ(locate(the_case, "geometry.boundary[2]")->key, "geometry.boundary.2");
}

TEST(Locate, FindsWhatIsAroundADefault) {
  const Case the_case = parse(sample_text);
  EXPECT_EQ(locate(the_case, "spec.solver.uzawa.p")->key, "solver.method");
  EXPECT_EQ(locate(the_case, "request_id"), nullptr);
  EXPECT_EQ(locate(the_case, ""), nullptr);
}

TEST(Locate, NamesTheOverrideThatWroteIt) {
  const Case the_case = parse(sample_text, {"solver.theta=-1"});
  EXPECT_EQ(prefix(*locate(the_case, "spec.solver.uzawa.theta")),
            "--set solver.theta=-1: solver.theta: ");
}

}  // namespace
}  // namespace anticrack::casefile
