// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "client/casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Mistake {
  const char* what;
  const char* from;
  const char* to;
  const char* complaint;  ///< the whole message
};

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, NameLineKeyValueAndCure) {
  const Mistake& mistake = GetParam();
  ASSERT_NE(sample_text.find(mistake.from), std::string::npos);
  EXPECT_EQ(complaint(sample_with(mistake.from, mistake.to)), mistake.complaint);
}

const Mistake mistakes[] = {
    {"unknown_key", "theta = 1.5", "thta = 1.5",
     "plate.toml:13: solver.thta: unknown key; did you mean theta?"},
    {"unknown_key_far_off", "theta = 1.5", "colour = 1.5",
     "plate.toml:13: solver.colour: unknown key; known are epsilon, mass, max_iterations, method, "
     "p, theta"},
    {"unknown_table", "[solver]", "[slover]",
     "plate.toml:12: slover: unknown key; did you mean solver?"},
    {"unknown_key_in_list", "f = 1\n", "force = 1\n",
     "plate.toml:17: load.0.force: unknown key; known are boundary_value, f, name"},
    {"theta_text", "theta = 1.5", "theta = \"fast\"",
     "plate.toml:13: solver.theta: 'fast' is no finite number; write a number above 0, or "
     "\"auto\""},
    {"theta_nan", "theta = 1.5", "theta = nan",
     "plate.toml:13: solver.theta: nan is no finite number; write a number above 0, or \"auto\""},
    {"epsilon_text", "theta = 1.5", "epsilon = \"1e-12\"",
     "plate.toml:13: solver.epsilon: '1e-12' is no finite number; write a number without quotes"},
    {"iterations_fraction", "theta = 1.5", "max_iterations = 1.5",
     "plate.toml:13: solver.max_iterations: 1.5 is no count; write a whole number from 1 to "
     "2147483647"},
    {"iterations_zero", "theta = 1.5", "max_iterations = 0",
     "plate.toml:13: solver.max_iterations: 0 is no count; write a whole number from 1 to "
     "2147483647"},
    {"unknown_method", "theta = 1.5", "method = \"usawa\"",
     "plate.toml:13: solver.method: 'usawa' is not possible; did you mean uzawa?"},
    {"method_number", "theta = 1.5", "method = 3",
     "plate.toml:13: solver.method: 3 is no text; write it in quotes"},
    {"foreign_parameter", "theta = 1.5", "method = \"active-set\"\ntheta = 1.5",
     "plate.toml:14: solver.theta: belongs to method \"uzawa\"; remove it, or write method = "
     "\"uzawa\""},
    {"solver_number", "[solver]\ntheta = 1.5", "[mesh]\npreset = 3",
     "plate.toml:13: mesh.preset: 3 is no text; write it in quotes"},
    {"size_without_uniform", "[solver]\ntheta = 1.5", "[mesh]\nsize = 3",
     "plate.toml:13: mesh.size: means nothing with this preset; write preset = \"uniform\" beside "
     "it"},
    {"file_and_geometry", "[solver]\ntheta = 1.5", "[mesh]\nfile = \"a.msh\"",
     "plate.toml:3: geometry: there is a mesh.file too; remove one of the two"},
    {"no_boundary", "boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n", "",
     "plate.toml:3: geometry.boundary: missing; write [[x, y], [x, y], ...]"},
    {"boundary_number", "[[-1, -1], [1, -1], [1, 1], [-1, 1]]", "3",
     "plate.toml:4: geometry.boundary: 3 is no list of points; write [[x, y], [x, y], ...]"},
    {"point_of_three", "[1, -1]", "[1, -1, 0]",
     "plate.toml:4: geometry.boundary.1: [ 1, -1, 0 ] is no point; write [x, y]"},
    {"point_of_text", "[1, -1]", "[1, \"a\"]",
     "plate.toml:4: geometry.boundary.1: 'a' is no finite number; write [x, y]"},
    {"point_infinite", "[1, -1]", "[1, inf]",
     "plate.toml:4: geometry.boundary.1: inf is no finite number; write [x, y]"},
    {"no_name", "name = \"fibre\"\n", "",
     "plate.toml:7: geometry.inclusion.0.name: missing; give the inclusion a name"},
    {"no_from", "from = [-0.5, 0]\n", "",
     "plate.toml:7: geometry.inclusion.0.from: missing; write [x, y], a point of the interface"},
    {"single_brackets", "[[geometry.inclusion]]", "[geometry.inclusion]",
     "plate.toml:7: geometry.inclusion: { from = [ -0.5, 0 ], name = 'fibre', to = [ 0.5, 0 ] } is "
     "no list of tables; write [[geometry.inclusion]] above each of them"},
    {"delaminated_text", "to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = \"yes\"",
     "plate.toml:11: geometry.inclusion.0.delaminated: 'yes' is not possible; write true, false or "
     "[[from, to], ...]"},
    {"delaminated_points", "to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = [[0, 0, 0]]",
     "plate.toml:11: geometry.inclusion.0.delaminated.0: [ 0, 0, 0 ] is no part; write [from, to] "
     "with points from and to"},
    {"no_f", "f = 1\n", "",
     "plate.toml:15: load.0.f: missing; write a number, an expression in x and y in quotes, or "
     "{region = number}"},
    {"f_list", "f = 1\n", "f = [1]\n",
     "plate.toml:17: load.0.f: [ 1 ] is no finite number; write a number, an expression in x and y "
     "in quotes, or {region = number}"},
    {"f_region_text", "f = 1\n", "f = {a = \"b\"}\n",
     "plate.toml:17: load.0.f.a: 'b' is no finite number; write one number for each region"},
    {"title_number", "title = \"A plate\"", "title = 3",
     "plate.toml:1: title: 3 is no text; write it in quotes"},
    {"fields_text", "[solver]\ntheta = 1.5", "[output]\nfields = \"yes\"",
     "plate.toml:13: output.fields: 'yes' is neither true nor false"},
};

INSTANTIATE_TEST_SUITE_P(Case, Mistakes, testing::ValuesIn(mistakes),
                         [](const auto& mistake) { return std::string(mistake.param.what); });

TEST(CaseErrors, SyntaxNamesTheLine) {
  EXPECT_THAT(complaint("title = \"A\"\n[geometry\n"),
              StartsWith("plate.toml:2: this is not TOML: "));
}

TEST(CaseErrors, NoLoadsAndNoGeometry) {
  EXPECT_EQ(complaint("title = \"A\"\n"),
            "plate.toml:1: geometry: missing; write [geometry] with boundary and interface, or "
            "mesh.file = \"x.msh\"");
  EXPECT_THAT(complaint("mesh.file = \"x.msh\"\n"), HasSubstr("load: missing; write [[load]]"));
}

TEST(CaseErrors, FileThatIsNotThere) {
  try {
    read_case("no/such/case.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "no/such/case.toml: cannot be read; name a case, a TOML file");
  }
  EXPECT_THROW(read_case(std::filesystem::temp_directory_path()), Error);
}

}  // namespace
}  // namespace anticrack::casefile
