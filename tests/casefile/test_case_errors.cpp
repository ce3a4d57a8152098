// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "casefile/sample_case.hpp"

namespace anticrack::casefile {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Mistake {
  const char* what;
  const char* from;
  const char* to;
  const char* complaint;  ///< the whole message
  std::vector<std::string> overrides = {};
};

class Mistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, NameLineKeyValueAndCure) {
  const Mistake& mistake = GetParam();
  ASSERT_NE(sample_text.find(mistake.from), std::string::npos);
  EXPECT_EQ(complaint(sample_with(mistake.from, mistake.to), mistake.overrides), mistake.complaint);
}

const Mistake mistakes[] = {
    {"unknown_key", "theta = 1.5", "thta = 1.5",
     "plate.toml:13: solver.thta: unknown key; did you mean theta?"},
    {"unknown_key_far_off", "theta = 1.5", "colour = 1.5",
     "plate.toml:13: solver.colour: unknown key; known are epsilon, kkt_tolerance, mass, "
     "max_iterations, max_steps, method, p, theta, tolerance"},
    {"unknown_table", "[solver]", "[slover]",
     "plate.toml:12: slover: unknown key; did you mean solver?"},
    {"unknown_key_in_list", "f = 1\n", "force = 1\n",
     "plate.toml:17: load.one.force: unknown key; known are boundary_value, f, inclusion_forces, "
     "inclusion_moments, name, point_forces, traction"},
    {"theta_text", "theta = 1.5", "theta = \"fast\"",
     "plate.toml:13: solver.theta: 'fast' is not a finite number; write a number above 0, or "
     "\"auto\""},
    {"theta_nan", "theta = 1.5", "theta = nan",
     "plate.toml:13: solver.theta: nan is not a finite number; write a number above 0, or "
     "\"auto\""},
    {"epsilon_text", "theta = 1.5", "epsilon = \"1e-12\"",
     "plate.toml:13: solver.epsilon: '1e-12' is not a finite number; write a number without "
     "quotes"},
    {"iterations_fraction", "theta = 1.5", "max_iterations = 1.5",
     "plate.toml:13: solver.max_iterations: 1.5 is not a count; write a whole number from 1 to "
     "2147483647"},
    {"iterations_zero", "theta = 1.5", "max_iterations = 0",
     "plate.toml:13: solver.max_iterations: 0 is not a count; write a whole number from 1 to "
     "2147483647"},
    {"unknown_method", "theta = 1.5\nmethod = \"uzawa\"", "method = \"usawa\"",
     "plate.toml:13: solver.method: 'usawa' is not possible; did you mean uzawa?"},
    {"method_number", "theta = 1.5\nmethod = \"uzawa\"", "method = 3",
     "plate.toml:13: solver.method: 3 is not text; write it in quotes"},
    {"foreign_parameter", "theta = 1.5\nmethod = \"uzawa\"", "method = \"active-set\"\ntheta = 1.5",
     "plate.toml:14: solver.theta: belongs to method \"uzawa\"; remove it, or write method = "
     "\"uzawa\""},
    {"solver_number", "[solver]\ntheta = 1.5\nmethod = \"uzawa\"", "[mesh]\npreset = 3",
     "plate.toml:13: mesh.preset: 3 is not text; write it in quotes"},
    {"file_and_geometry", "[solver]\ntheta = 1.5\nmethod = \"uzawa\"", "[mesh]\nfile = \"a.msh\"",
     "plate.toml:3: geometry: there is a mesh.file too; remove one of the two"},
    {"no_boundary", "boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n", "",
     "plate.toml:3: geometry.boundary: missing; write [[x, y], [x, y], ...], or "
     "[[geometry.boundary]] for each side"},
    {"boundary_number", "[[-1, -1], [1, -1], [1, 1], [-1, 1]]", "3",
     "plate.toml:4: geometry.boundary: 3 is not a list of points; write [[x, y], [x, y], ...]"},
    {"point_of_three", "[1, -1]", "[1, -1, 0]",
     "plate.toml:4: geometry.boundary.1: [ 1, -1, 0 ] is not a point; write [x, y]"},
    {"point_of_text", "[1, -1]", "[1, \"a\"]",
     "plate.toml:4: geometry.boundary.1: 'a' is not a finite number; write [x, y]"},
    {"point_infinite", "[1, -1]", "[1, inf]",
     "plate.toml:4: geometry.boundary.1: inf is not a finite number; write [x, y]"},
    {"no_name", "name = \"fibre\"\n", "",
     "plate.toml:7: geometry.inclusion.0.name: missing; give the inclusion a name"},
    {"no_from", "from = [-0.5, 0]\n", "",
     "plate.toml:7: geometry.inclusion.fibre.from: missing; write [x, y], a point of an interface, "
     "or a line of its own: points, arc, spline, or center, angle and length"},
    {"single_brackets", "[[geometry.inclusion]]", "[geometry.inclusion]",
     "plate.toml:7: geometry.inclusion: { from = [ -0.5, 0 ], name = 'fibre', to = [ 0.5, 0 ] } is "
     "not a list of tables; write [[geometry.inclusion]] above each of them"},
    {"delaminated_text", "to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = \"yes\"",
     "plate.toml:11: geometry.inclusion.fibre.delaminated: 'yes' is not possible; write true, "
     "false, \"left\", \"right\", [[from, to], ...] or [[0.5, 1.0], ...], stretches of its length"},
    {"delaminated_points", "to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = [[[0, 0]]]",
     "plate.toml:11: geometry.inclusion.fibre.delaminated.0: [ [ 0, 0 ] ] is not a part; a part is "
     "[from, to], and a list of parts [[from, to]]"},
    {"delaminated_stretch", "to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = [[0, 0.5, 1]]",
     "plate.toml:11: geometry.inclusion.fibre.delaminated.0: [ 0, 0.5, 1 ] is not a stretch; write "
     "[0.5, 1.0], by arc length over the whole length"},
    {"side_unknown", "to   = [0.5, 0]", "to   = [0.5, 0]\nside = \"up\"",
     "plate.toml:11: geometry.inclusion.fibre.side: 'up' is not possible; known are left, right"},
    {"two_sides", "to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = \"left\"\nside = \"left\"",
     "plate.toml:12: geometry.inclusion.fibre.side: delaminated names a side too; remove one of "
     "the two"},
    {"side_of_none", "to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = false\nside = \"left\"",
     "plate.toml:12: geometry.inclusion.fibre.side: nothing comes off on it, as delaminated = "
     "false; remove one of the two"},
    {"length_0", "from = [-0.5, 0]\nto   = [0.5, 0]", "center = [0, 0.5]\nlength = 0",
     "plate.toml:10: geometry.inclusion.fibre.length: 0 is not above 0; write a number above 0"},
    {"length_of_no_number", "from = [-0.5, 0]\nto   = [0.5, 0]",
     "center = [0, 0.5]\nlength = \"infinite\"",
     "plate.toml:10: geometry.inclusion.fibre.length: 'infinite' is not a finite number; write a "
     "number without quotes"},
    {"length_with_a_unit", "from = [-0.5, 0]\nto   = [0.5, 0]",
     "center = [0, 0.5]\nlength = \"-1.5e2 mm\"",
     "plate.toml:10: geometry.inclusion.fibre.length: '-1.5e2 mm' is a number with a unit; write "
     "-1.5e2: the units of all numbers are those of [units]"},
    {"part_and_line", "to   = [0.5, 0]", "to   = [0.5, 0]\ncenter = [0, 0.5]\nlength = 1",
     "plate.toml:9: geometry.inclusion.fibre.from: belongs to a part of an interface, but the "
     "inclusion has center, a line of its own; remove one of the two"},
    {"two_lines", "to   = [0.5, 0]", "points = [[0, 0], [1, 1]]\ncenter = [0, 0.5]",
     "plate.toml:11: geometry.inclusion.fibre.center: the inclusion has points too; remove one of "
     "the two"},
    {"no_length", "from = [-0.5, 0]\nto   = [0.5, 0]", "center = [0, 0.5]",
     "plate.toml:7: geometry.inclusion.fibre.length: missing; write its length, beside its center"},
    {"angle_text", "from = [-0.5, 0]\nto   = [0.5, 0]",
     "center = [0, 0.5]\nlength = 1\nangle = \"20\"",
     "plate.toml:11: geometry.inclusion.fibre.angle: '20' is not a finite number; write a number "
     "without quotes"},
    {"angle_without_center", "to   = [0.5, 0]", "to   = [0.5, 0]\nangle = 20",
     "plate.toml:11: geometry.inclusion.fibre.angle: belongs to center; write center = [x, y], "
     "angle in degrees and length"},
    {"no_f", "f = 1\n", "",
     "plate.toml:15: load.one.f: missing; write a number, an expression in x and y in quotes, "
     "{region = number} or {file = \"f.h5\", dataset = \"/f\", per = \"triangle\"}"},
    {"f_list", "f = 1\n", "f = [1]\n",
     "plate.toml:17: load.one.f: [ 1 ] is not a finite number; write a number, an expression in x "
     "and y in quotes, {region = number} or {file = \"f.h5\", dataset = \"/f\", per = "
     "\"triangle\"}"},
    {"f_region_text", "f = 1\n", "f = {a = \"b\"}\n",
     "plate.toml:17: load.one.f.a: 'b' is not a finite number; write one number for each region"},
    {"title_number", "title = \"A plate\"", "title = 3",
     "plate.toml:1: title: 3 is not text; write it in quotes"},
    {"fields_text", "[solver]\ntheta = 1.5\nmethod = \"uzawa\"", "[output]\nfields = \"yes\"",
     "plate.toml:13: output.fields: 'yes' is neither true nor false"},
};

/// The sample's interface, replaced.
Mistake interface(const char* what, const char* to, const char* complaint) {
  return {what, "interface = [[-1, 0], [1, 0]]\n", to, complaint};
}

/// A [mesh] of its own in place of the sample's [solver]; its first key is in line 13.
Mistake mesh(const char* what, const char* to, const char* complaint) {
  return {what, "[solver]\ntheta = 1.5\nmethod = \"uzawa\"", to, complaint};
}

/// Keys of the first load, from line 17.
Mistake load(const char* what, const char* to, const char* complaint) {
  return {what, "f = 1\n", to, complaint};
}

const Mistake geometry_mistakes[] = {
    interface(
        "interface_number", "interface = 3\n",
        "plate.toml:5: geometry.interface: 3 is not a list of points; write [[x, y], [x, y], ...]"),
    interface("interface_key", "[[geometry.interface]]\npoint = [[0, 0], [1, 0]]\n",
              "plate.toml:6: geometry.interface.0.point: unknown key; did you mean points?"),
    interface("interface_without_shape", "[[geometry.interface]]\nname = \"a\"\n",
              "plate.toml:5: geometry.interface.a: an interface without a shape; write points = "
              "[[x, y], ...], arc = [from, through, to] or spline = [[x, y], ...]"),
    interface(
        "interface_of_two_shapes",
        "[[geometry.interface]]\npoints = [[-1, 0], [1, 0]]\narc = [[-1, 0], [0, 1], [1, 0]]\n",
        "plate.toml:7: geometry.interface.0.arc: the interface has points too; remove one of the "
        "two"),
    interface("arc_of_two", "[[geometry.interface]]\narc = [[-1, 0], [1, 0]]\n",
              "plate.toml:6: geometry.interface.0.arc: [ [ -1, 0 ], [ 1, 0 ] ] is not an arc; "
              "write [from, through, to], three points with the second between the others"),
    interface("closed_arc",
              "[[geometry.interface]]\narc = [[-1, 0], [0, 1], [1, 0]]\nclosed = true\n",
              "plate.toml:7: geometry.interface.0.closed: an arc has two ends; remove the key, or "
              "write a spline through the points"),
    interface("closed_text", "[[geometry.interface]]\nspline = [[-1, 0], [1, 0]]\nclosed = 1\n",
              "plate.toml:7: geometry.interface.0.closed: 1 is neither true nor false"),
    interface("interface_name", "[[geometry.interface]]\nname = 1\n",
              "plate.toml:6: geometry.interface.0.name: 1 is not text; write it in quotes"),
    interface("spline_point", "[[geometry.interface]]\nspline = [[-1, 0], [1]]\n",
              "plate.toml:6: geometry.interface.0.spline.1: [ 1 ] is not a point; write [x, y]"),
    interface(
        "neumann_text", "neumann = \"left\"\n",
        "plate.toml:5: geometry.neumann: 'left' is not possible; write a list of names of sides "
        "and holes, or of [from, to], parts of the boundary walked counterclockwise, or \"all\""),
    interface("neumann_number", "neumann = [\"left\", 2]\n",
              "plate.toml:5: geometry.neumann.1: 2 is not a part; a part is [from, to], and a list "
              "of parts [[from, to]]"),
    interface("hole_without_shape", "[[geometry.hole]]\nname = \"window\"\n",
              "plate.toml:5: geometry.hole.window: the hole without a shape; write circle = { "
              "center = [x, y], radius = r }, points = [[x, y], ...] or spline = [[x, y], ...]"),
    interface("hole_key", "[[geometry.hole]]\ncirlce = {}\n",
              "plate.toml:6: geometry.hole.0.cirlce: unknown key; did you mean circle?"),
    interface(
        "hole_of_two_shapes",
        "[[geometry.hole]]\ncircle = { center = [0, 0], radius = 1 }\nspline = []\n",
        "plate.toml:7: geometry.hole.0.spline: the hole has circle too; remove one of the two"),
    interface("radius_zero", "[[geometry.hole]]\ncircle = { center = [0, 0], radius = 0 }\n",
              "plate.toml:6: geometry.hole.0.circle.radius: 0 is not above 0; write a number above "
              "0"),
    interface("circle_without_radius", "[[geometry.hole]]\ncircle = { center = [0, 0] }\n",
              "plate.toml:6: geometry.hole.0.circle.radius: missing; write its radius"),
    interface(
        "circle_number", "[[geometry.hole]]\ncircle = 3\n",
        "plate.toml:6: geometry.hole.0.circle: 3 is not a table; write [geometry.hole.0.circle]"),
    interface(
        "region_at_and_outline", "[[geometry.region]]\nname = \"r\"\nat = [0, 0]\npoints = []\n",
        "plate.toml:8: geometry.region.r.points: the region has at too; remove one of the two"),
    {"side_without_shape", "boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]",
     "boundary = [{ name = \"left\" }]",
     "plate.toml:4: geometry.boundary.left: a side without a shape; write points = [[x, y], ...], "
     "arc = [from, through, to] or spline = [[x, y], ...]"},
    {"side_key", "boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]", "boundary = [{ point = [] }]",
     "plate.toml:4: geometry.boundary.0.point: unknown key; did you mean points?"},
    {"side_of_a_crack", "[[geometry.inclusion]]\n", "[[geometry.crack]]\nside = \"left\"\n",
     "plate.toml:8: geometry.crack.fibre.side: belongs to [[geometry.inclusion]]; the plus side of "
     "a crack is on its left, so write it the other way round"},
    interface("neumann_point", "neumann = [[1, -1], [1, 1]]\n",
              "plate.toml:5: geometry.neumann.0.0: 1 is not a point; write [x, y]"),
    interface("neumann_three", "neumann = [[[1, -1], [1, 1], [0, 0]]]\n",
              "plate.toml:5: geometry.neumann.0: [ [ 1, -1 ], [ 1, 1 ], [ 0, 0 ] ] is not a part; "
              "a part is [from, to], and a list of parts [[from, to]]"),
    {"contact_of_an_inclusion", "from = [-0.5, 0]\n", "from = [-0.5, 0]\ncontact = false\n",
     "plate.toml:10: geometry.inclusion.fibre.contact: belongs to [[geometry.crack]]; an inclusion "
     "has delaminated = true or false"},
    {"fixed_text", "from = [-0.5, 0]\n", "from = [-0.5, 0]\nfixed = \"yes\"\n",
     "plate.toml:10: geometry.inclusion.fibre.fixed: 'yes' is not a finite number; write a number "
     "without quotes"},
    {"tilt_number", "from = [-0.5, 0]\n", "from = [-0.5, 0]\ntilt = 1\n",
     "plate.toml:10: geometry.inclusion.fibre.tilt: 1 is neither true nor false"},
    {"tilt_of_a_crack", "[[geometry.inclusion]]\n", "[[geometry.crack]]\ntilt = false\n",
     "plate.toml:8: geometry.crack.fibre.tilt: belongs to [[geometry.inclusion]]; nothing rigid "
     "lies on a crack, so remove it"},
    interface("region_without_name", "[[geometry.region]]\nat = [0, 1]\n",
              "plate.toml:5: geometry.region.0.name: missing; give the region a name"),
    interface("region_without_at", "[[geometry.region]]\nname = \"top\"\n",
              "plate.toml:5: geometry.region.top.at: missing; write [x, y], a point inside the "
              "region, or its outline: circle, points or spline"),
    interface("region_key", "[[geometry.region]]\nname = \"top\"\nat = [0, 1]\ntensoin = 2\n",
              "plate.toml:8: geometry.region.top.tensoin: unknown key; did you mean tension?"),
    interface("tension_zero", "[[geometry.region]]\nname = \"top\"\nat = [0, 1]\ntension = 0\n",
              "plate.toml:8: geometry.region.top.tension: 0 is not above 0; write a number above "
              "0, or leave the key out for its default"),
    interface("tension_across_alone",
              "[[geometry.region]]\nname = \"top\"\nat = [0, 1]\ntension = { across = 2 }\n",
              "plate.toml:8: geometry.region.top.tension.along: missing; write the tension in the "
              "direction of angle, a number or an expression"),
};

const Mistake mesh_mistakes[] = {
    mesh("mesh_key", "[mesh]\ngradin = 0.2",
         "plate.toml:13: mesh.gradin: unknown key; did you mean grading?"),
    mesh("size_negative", "[mesh]\nsize = -1",
         "plate.toml:13: mesh.size: -1 is not above 0; write a number above 0, or leave the key "
         "out for its default"),
    mesh("tip_size_text", "[mesh]\ntip_size = \"small\"",
         "plate.toml:13: mesh.tip_size: 'small' is not a finite number; write a number without "
         "quotes"),
    mesh("grading_zero", "[mesh]\ngrading = 0",
         "plate.toml:13: mesh.grading: 0 is not above 0; write a number above 0, or leave the key "
         "out for its default"),
    mesh("align_number", "[mesh]\nalign = 3",
         "plate.toml:13: mesh.align: 3 is not a list of lines; write [[[x, y], [x, y], ...], ...]"),
    mesh("align_one_line", "[mesh]\nalign = [[0, 0], [1, 1]]",
         "plate.toml:13: mesh.align.0.0: 0 is not a point; write [x, y]"),
    mesh("motion_number", "[mesh]\nfile = \"a.msh\"\n[mesh.inclusions]\nfibre = 1",
         "plate.toml:15: mesh.inclusions.fibre: 1 is not a table; write NAME = { tilt = true } or "
         "NAME = { fixed = 0.1 } for each of them"),
    mesh("motion_list", "[mesh]\nfile = \"a.msh\"\ninclusions = [\"fibre\"]",
         "plate.toml:14: mesh.inclusions: [ 'fibre' ] is not a table; write NAME = { tilt = true } "
         "or NAME = { fixed = 0.1 } for each of them"),
    mesh("motion_key", "[mesh]\nfile = \"a.msh\"\n[mesh.inclusions]\nfibre = { tlit = true }",
         "plate.toml:15: mesh.inclusions.fibre.tlit: unknown key; did you mean tilt?"),
    mesh("motion_nan", "[mesh]\nfile = \"a.msh\"\n[mesh.inclusions]\nfibre.fixed = nan",
         "plate.toml:15: mesh.inclusions.fibre.fixed: nan is not a finite number; write a finite "
         "number"),
    mesh("groups_key", "[mesh]\nfile = \"a.msh\"\n[mesh.groups]\ncurves.7 = \"crack\"",
         "plate.toml:15: mesh.groups.curves: unknown key; did you mean curve?"),
    mesh(
        "group_tag", "[mesh]\nfile = \"a.msh\"\n[mesh.groups]\ncurve.seven = \"crack\"",
        "plate.toml:15: mesh.groups.curve.seven: 'seven' is not a tag; write the tag of a physical "
        "group and its meaning in quotes, for example curve.7 = \"crack\" or surface.1 = \"top\""),
    mesh("group_meaning", "[mesh]\nfile = \"a.msh\"\n[mesh.groups.surface]\n1 = 2",
         "plate.toml:15: mesh.groups.surface.1: 2 is not a meaning of a group; write the tag of a "
         "physical group and its meaning in quotes, for example curve.7 = \"crack\" or surface.1 = "
         "\"top\""),
    mesh("group_list", "[mesh]\nfile = \"a.msh\"\ngroups.curve = [7]",
         "plate.toml:14: mesh.groups.curve: [ 7 ] is not a table; write the tag of a physical "
         "group and its meaning in quotes, for example curve.7 = \"crack\" or surface.1 = \"top\""),
    mesh("mesh_tension_list", "[mesh]\nfile = \"a.msh\"\ntension.top = [2]",
         "plate.toml:14: mesh.tension.top: [ 2 ] is not a finite number; write a finite number"),
    mesh("mesh_tension_number", "[mesh]\nfile = \"a.msh\"\ntension = 2",
         "plate.toml:14: mesh.tension: 2 is not a table; write subdomain = tension for each"),
    mesh("steps_of_uzawa", "[solver]\nmethod = \"uzawa\"\nmax_steps = 3",
         "plate.toml:14: solver.max_steps: belongs to method \"active-set\"; remove it, or write "
         "method = \"active-set\""),
    mesh("kkt_tolerance_of_active_set", "[solver]\nkkt_tolerance = 1e-8",
         "plate.toml:13: solver.kkt_tolerance: belongs to method \"uzawa\"; remove it, or write "
         "method = \"uzawa\""),
    mesh("tolerance_text", "[solver]\ntolerance = \"tiny\"",
         "plate.toml:13: solver.tolerance: 'tiny' is not a finite number; write a number without "
         "quotes"),
    mesh("steps_zero", "[solver]\nmax_steps = 0",
         "plate.toml:13: solver.max_steps: 0 is not a count; write a whole number from 1 to "
         "2147483647"),
};

const Mistake load_mistakes[] = {
    load("file_without_dataset", "f = {file = \"f.h5\", per = \"node\"}\n",
         "plate.toml:17: load.one.f.dataset: missing; name the dataset in the file, as \"/f\""),
    load("file_without_per", "f = {file = \"f.h5\", dataset = \"/f\"}\n",
         "plate.toml:17: load.one.f.per: missing; write per = \"triangle\" or per = \"node\""),
    load("dataset_without_file", "f = {dataset = \"/f\", per = \"node\"}\n",
         "plate.toml:17: load.one.f.file: missing; name an HDF5 file"),
    load("per_unknown", "f = {file = \"f.h5\", dataset = \"/f\", per = \"nodes\"}\n",
         "plate.toml:17: load.one.f.per: 'nodes' is not possible; did you mean node?"),
    load("file_key", "f = {file = \"f.h5\", datset = \"/f\", per = \"node\"}\n",
         "plate.toml:17: load.one.f.datset: unknown key; did you mean dataset?"),
    load("traction_list", "traction = [1]\n",
         "plate.toml:17: load.one.traction: [ 1 ] is not a finite number; write a number, or an "
         "expression in x and y in quotes"),
    load("boundary_value_nan", "boundary_value = nan\n",
         "plate.toml:17: load.one.boundary_value: nan is not a finite number; write a number, or "
         "an expression in x and y in quotes"),
    load("point_force_key", "point_forces = [{at = [0, 0], valeu = 1}]\n",
         "plate.toml:17: load.one.point_forces.0.valeu: unknown key; did you mean value?"),
    load("point_force_without_at", "point_forces = [{value = 1}]\n",
         "plate.toml:17: load.one.point_forces.0.at: missing; write [x, y], where the force acts"),
    load("point_force_without_value", "point_forces = [{at = [0, 0]}]\n",
         "plate.toml:17: load.one.point_forces.0.value: missing; write the force, a number"),
    load("point_force_text", "point_forces = [{at = [0, 0], value = \"1\"}]\n",
         "plate.toml:17: load.one.point_forces.0.value: '1' is not a finite number; write a number "
         "without quotes"),
    load("inclusion_forces_number", "inclusion_forces = 2\n",
         "plate.toml:17: load.one.inclusion_forces: 2 is not a table; write inclusion = number for "
         "each of them"),
    load("inclusion_force_text", "inclusion_forces = {fibre = \"2\"}\n",
         "plate.toml:17: load.one.inclusion_forces.fibre: '2' is not a finite number; write "
         "inclusion = number for each of them"),
    load("inclusion_moments_list", "inclusion_moments = [0, 1]\n",
         "plate.toml:17: load.one.inclusion_moments: [ 0, 1 ] is not a table; write inclusion = "
         "[Mx, My] for each of them"),
    load("inclusion_moment_number", "inclusion_moments = {fibre = 2}\n",
         "plate.toml:17: load.one.inclusion_moments.fibre: 2 is not a moment; write inclusion = "
         "[Mx, My] for each of them"),
    load("inclusion_moment_of_three", "inclusion_moments = {fibre = [0, 0, 2]}\n",
         "plate.toml:17: load.one.inclusion_moments.fibre: [ 0, 0, 2 ] is not a moment; write "
         "inclusion = [Mx, My] for each of them"),
    load("inclusion_moment_nan", "inclusion_moments = {fibre = [0, nan]}\n",
         "plate.toml:17: load.one.inclusion_moments.fibre: nan is not a finite number; write "
         "inclusion = [Mx, My] for each of them"),
};

std::string name_of(const ::testing::TestParamInfo<Mistake>& mistake) { return mistake.param.what; }

INSTANTIATE_TEST_SUITE_P(Case, Mistakes, ::testing::ValuesIn(mistakes), name_of);
INSTANTIATE_TEST_SUITE_P(Geometry, Mistakes, ::testing::ValuesIn(geometry_mistakes), name_of);
INSTANTIATE_TEST_SUITE_P(Mesh, Mistakes, ::testing::ValuesIn(mesh_mistakes), name_of);
INSTANTIATE_TEST_SUITE_P(Load, Mistakes, ::testing::ValuesIn(load_mistakes), name_of);

TEST(CaseErrors, SyntaxNamesTheLine) {
  EXPECT_THAT(complaint("title = \"A\"\n[geometry\n"),
              AllOf(StartsWith("plate.toml:2: column 10: this is not TOML: "),
                    EndsWith("; the line is: [geometry")));
  const std::string cure =
      "; a value is a number as 3.5, true, false, a text in quotes or a list; units are named in "
      "[units]; the line is: ";
  for (const std::string line :
       {"length = 100 mm", "length = 3,5", "tilt = True", "side = right", "length ="})
    EXPECT_THAT(complaint("title = \"A\"\n" + line + "\n"), EndsWith(cure + line));
  for (const std::string line : {"[geometry", "leng th = 3", "title = \"B\""})
    EXPECT_THAT(complaint("title = \"A\"\n" + line + "\n"), Not(HasSubstr("a value is")));
  EXPECT_EQ(complaint(std::string("title\0", 6)),
            "plate.toml: this is not text; name a case, a TOML file");
}

TEST(CaseErrors, NoLoadsAndNoGeometry) {
  EXPECT_EQ(complaint("title = \"A\"\n"),
            "plate.toml: geometry: missing; write [geometry] with boundary and interface, or "
            "mesh.file = \"x.msh\"");
  EXPECT_THAT(complaint("mesh.file = \"x.msh\"\n"), HasSubstr("load: missing; write [[load]]"));
}

TEST(Complaint, OfAKeyOfManyParts) {
  std::string plain = "a", quoted = "a";
  for (int i = 0; i < 200'000; ++i) plain += ".a";
  for (int i = 0; i < 40; ++i) quoted += ".\"=,[]#\\\"\"";
  const std::string problem =
      ": a key of more than 32 parts; shorten it: known keys have at most 5";
  for (const std::string& key : {plain, quoted}) {
    for (const std::string& text :
         {key + " = 1\n", "[" + key + "]\n", "x = { " + key + " = 1 }\n"}) {
      EXPECT_EQ(complaint("title = \"long\"\n" + text), "plate.toml:2" + problem);
    }
    EXPECT_EQ(complaint("x = { a = \"\"\"\nit's \\\n\"\"\"\"\", " + key + " = 1 }\n"),
              "plate.toml:3" + problem);
    EXPECT_EQ(complaint("title = \"open \\\n" + key + " = 1\n"), "plate.toml:2" + problem);
    EXPECT_NE(complaint("", {"load={ " + key + " = 1 }"}), "");
  }
  EXPECT_EQ(complaint("", {plain + "=1"}), "--set" + problem);  // knows no quotes
  const std::string dots(1500, '.');
  EXPECT_EQ(complaint("# " + dots + "\ntitle = \"" + dots + "\"\n").find("parts"),
            std::string::npos);
  EXPECT_EQ(complaint("", {"title=" + dots}).find("parts"), std::string::npos);
}

TEST(Complaint, OfTheDeepestNestingThatIsParsed) {
  std::string key = "a";
  for (int i = 1; i < 32; ++i) key += ".a";
  std::string text = key + " = ";
  for (int i = 0; i < 250; ++i) text += "{ " + key + " = ";
  text += "1";
  for (int i = 0; i < 250; ++i) text += " }";
  EXPECT_NE(complaint(text + "\n"), "");
}

}  // namespace
}  // namespace anticrack::casefile
