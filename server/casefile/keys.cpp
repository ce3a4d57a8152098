// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/keys.hpp"

#include <algorithm>
#include <cctype>

namespace anticrack::casefile {
namespace {

constexpr std::string_view points_form = "[[x, y], [x, y], ...]";

constexpr Key curve_rows[] = {
    {.name = "points",
     .type = Type::structure,
     .form = points_form,
     .unit = "L",
     .meaning = "straight between these points"},
    {.name = "arc",
     .type = Type::structure,
     .form = "[from, through, to]",
     .unit = "L",
     .meaning = "an arc of a circle through three points"},
    {.name = "spline",
     .type = Type::structure,
     .form = points_form,
     .unit = "L",
     .meaning = "a smooth line through the points, at least 3"},
};

constexpr Key segment_rows[] = {
    {.name = "center",
     .type = Type::point,
     .unit = "L",
     .field = "line.segment.center",
     .meaning = "the middle of a straight line; with angle and length"},
    {.name = "angle",
     .type = Type::number,
     .unit = "degrees",
     .if_absent = "0",
     .field = "line.segment.angle",
     .meaning = "of a straight line, counterclockwise from the x axis; with center"},
    {.name = "length",
     .type = Type::positive,
     .unit = "L",
     .if_absent = "needed with center",
     .field = "line.segment.length",
     .meaning = "of a straight line; with center"},
};

constexpr Key circle_rows[] = {
    {.name = "center",
     .type = Type::point,
     .unit = "L",
     .meaning = "its middle",
     .need = "write [x, y]"},
    {.name = "radius",
     .type = Type::positive,
     .unit = "L",
     .meaning = "its radius",
     .need = "write its radius"},
};
constexpr Keys circle_keys{v1::Circle::descriptor, {circle_rows}};

constexpr Key outline_rows[] = {
    {.name = "circle",
     .type = Type::table,
     .form = "{ center = [x, y], radius = r }",
     .field = "outline.circle",
     .meaning = "a circle",
     .below = &circle_keys},
    {.name = "points",
     .type = Type::structure,
     .form = points_form,
     .unit = "L",
     .meaning = "a polygon; its last point is joined to its first"},
    {.name = "spline",
     .type = Type::structure,
     .form = points_form,
     .unit = "L",
     .meaning = "a smooth closed line through the points, at least 3"},
};

constexpr Key side_rows[] = {
    {.name = "name",
     .if_absent = "side-1, side-2, ... by its place, also of a polygon's edges",
     .meaning = "for geometry.neumann"},
};
constexpr Keys side_keys{v1::Side::descriptor, {side_rows, curve_rows, segment_rows}};

constexpr Key hole_rows[] = {
    {.name = "name",
     .if_absent = "hole-1, hole-2, ... by its place",
     .meaning = "for geometry.neumann"},
};
constexpr Keys hole_keys{v1::Hole::descriptor, {hole_rows, outline_rows}};

constexpr Key interface_rows[] = {
    {.name = "name",
     .if_absent = "\"interface\" if it is the only one, else \"interface-2\", ...",
     .meaning = "what results call it"},
    {.name = "closed",
     .type = Type::boolean,
     .if_absent = "false",
     .meaning = "true: a ring, its last point is joined to its first; of points and splines"},
};
constexpr Keys interface_keys{v1::InterfaceCurve::descriptor, {interface_rows, curve_rows}};

constexpr Key motion_rows[] = {
    {.name = "tilt",
     .type = Type::boolean,
     .if_absent = "false: u = A",
     .meaning = "true: a straight inclusion moves by u = A + B s, s from its middle, any other as "
                "a thin rigid plate, u = A + Bx (x - x0) + By (y - y0) about the middle of its "
                "bounding box"},
    {.name = "fixed",
     .type = Type::number,
     .unit = "L",
     .if_absent = "it is not held",
     .meaning = "u of an inclusion that is held; it does not tilt, and a force on it is refused"},
};
constexpr Keys motion_keys{v1::InclusionMotion::descriptor, {motion_rows}};

constexpr Key inclusion_rows[] = {
    {.name = "name",
     .meaning = "unique among inclusions and cracks",
     .need = "give the inclusion a name"},
    {.name = "from",
     .type = Type::point,
     .unit = "L",
     .if_absent = "needed unless it has a line of its own",
     .field = "part.from",
     .meaning = "where it begins, a point of an interface. In place of from and to it may have a "
                "line of its own, an interface with its name: points, arc, spline, or center, "
                "angle and length"},
    {.name = "to",
     .type = Type::point,
     .unit = "L",
     .if_absent = "needed with from",
     .field = "part.to",
     .meaning = "where it ends, a point of the same interface"},
    {.name = "delaminated",
     .type = Type::structure,
     .form = "true, false, \"left\", \"right\", or a list of [from, to]: points, or stretches of "
             "its length such as [0.5, 1.0]",
     .if_absent = "true",
     .field = "delaminated_parts",
     .meaning = "which part of it comes off; the rest is bonded"},
    {.name = "side",
     .type = Type::choice,
     .if_absent = "\"right\", of a part of an interface its minus side",
     .field = "delaminated_side",
     .meaning = "the side that comes off, seen walking along it; beside a list or true in "
                "delaminated"},
    {.name = "contact",
     .type = Type::refused,
     .meaning = "belongs to [[geometry.crack]]; an inclusion has delaminated = true or false"},
    motion_rows[0],
    motion_rows[1],
};
constexpr Keys inclusion_keys{v1::Inclusion::descriptor,
                              {inclusion_rows, curve_rows, segment_rows}};

constexpr const char* not_rigid =
    "belongs to [[geometry.inclusion]]; nothing rigid lies on a crack, so remove it";
constexpr Key crack_rows[] = {
    {.name = "name",
     .meaning = "unique among inclusions and cracks",
     .need = "give the crack a name"},
    inclusion_rows[1],
    inclusion_rows[2],
    {.name = "contact",
     .type = Type::boolean,
     .if_absent = "true: [u] >= 0",
     .meaning = "false: its faces are free, as in mode III, and [u] has either sign"},
    {.name = "tilt", .type = Type::refused, .meaning = not_rigid},
    {.name = "fixed", .type = Type::refused, .meaning = not_rigid},
    {.name = "side",
     .type = Type::refused,
     .meaning = "belongs to [[geometry.inclusion]]; the plus side of a crack is on its left, so "
                "write it the other way round"},
};
constexpr Keys crack_keys{v1::Crack::descriptor, {crack_rows, curve_rows, segment_rows}};

constexpr Key law_rows[] = {
    {.name = "along",
     .type = Type::expression,
     .unit = "F/L",
     .meaning = "the tension in the direction of angle",
     .need = "write the tension in the direction of angle, a number or an expression"},
    {.name = "across",
     .type = Type::expression,
     .unit = "F/L",
     .if_absent = "as along",
     .meaning = "the tension perpendicular to it"},
    {.name = "angle",
     .type = Type::number,
     .unit = "degrees",
     .if_absent = "0",
     .meaning = "counterclockwise from the x axis"},
};
constexpr Keys law_keys{v1::Tension::descriptor, {law_rows}};

constexpr std::string_view tension_form =
    "number > 0, expression in x and y, or { along, across, angle }";

constexpr Key region_rows[] = {
    {.name = "name",
     .meaning = "of the subdomain, else omega1, omega2, ...; for load.f",
     .need = "give the region a name"},
    {.name = "at",
     .type = Type::point,
     .unit = "L",
     .if_absent = "needed without an outline",
     .meaning = "any point inside it. In place of it an outline, circle, points or spline: the "
                "inside without regions that lie in it"},
    {.name = "tension",
     .type = Type::structure,
     .form = tension_form,
     .unit = "F/L",
     .if_absent =
         "1, with a note where other regions give one, or none does though there are units",
     .meaning = "T of -div(T grad u) = f. Of a table T is the symmetric matrix with the eigenvalue "
                "along in the direction of angle and across perpendicular to it. Each triangle has "
                "the mean of each; bounds are those of T itself",
     .below = &law_keys},
};
constexpr Keys region_keys{v1::Region::descriptor, {region_rows, outline_rows}};

constexpr Key geometry_rows[] = {
    {.name = "boundary",
     .type = Type::structure,
     .form = "[[x, y], [x, y], ...], or a table for each side",
     .unit = "L",
     .meaning = "a polygon, or sides, each of which begins where the one before it ends",
     .need = "write [[x, y], [x, y], ...], or [[geometry.boundary]] for each side",
     .below = &side_keys,
     .many = true},
    {.name = "hole",
     .type = Type::structure,
     .form = "a table for each",
     .field = "holes",
     .meaning = "part of the boundary; touches neither the rest of it nor another hole",
     .below = &hole_keys,
     .many = true},
    {.name = "interface",
     .type = Type::structure,
     .form = "[[x, y], [x, y], ...], or a table for each",
     .unit = "L",
     .if_absent = "none",
     .field = "interfaces",
     .meaning = "lines for inclusions and cracks to lie on; the plus side is on their left",
     .below = &interface_keys,
     .many = true},
    {.name = "inclusion",
     .type = Type::structure,
     .form = "a table for each",
     .field = "inclusions",
     .meaning = "thin rigid inclusions",
     .below = &inclusion_keys,
     .many = true},
    {.name = "crack",
     .type = Type::structure,
     .form = "a table for each",
     .field = "cracks",
     .meaning = "cracks",
     .below = &crack_keys,
     .many = true},
    {.name = "neumann",
     .type = Type::structure,
     .form = "list of names of sides and holes, or of [from, to] on the outer boundary walked "
             "counterclockwise; or \"all\"",
     .if_absent = "u = g_D on all of the boundary",
     .meaning = "where a traction acts. A straight side written clockwise is refused, as it would "
                "mean the rest of the boundary"},
    {.name = "region",
     .type = Type::structure,
     .form = "a table for each",
     .field = "regions",
     .meaning = "names a subdomain and gives it its tension",
     .below = &region_keys,
     .many = true},
};
constexpr Keys geometry_keys{v1::Geometry::descriptor, {geometry_rows}};

constexpr Key group_rows[] = {
    {.name = "curve",
     .type = Type::structure,
     .form = "{ TAG = \"meaning\" }",
     .meaning = "of physical curves by their number: \"dirichlet\", \"neumann\", \"crack\", "
                "\"crack:NAME\", \"free\", \"free:NAME\", \"inclusion:NAME\", "
                "\"delaminated:NAME\" or \"glue\""},
    {.name = "surface",
     .type = Type::structure,
     .form = "{ TAG = \"name\" }",
     .meaning = "the names of subdomains by the number of their physical surface"},
};
constexpr Keys group_keys{v1::MeshOptions::descriptor, {group_rows}};

constexpr Key mesh_rows[] = {
    {.name = "preset",
     .type = Type::choice,
     .if_absent = "\"graded\", with [accuracy] \"coarse\"",
     .meaning = "\"graded\": bisected towards every tip; \"coarse\": the same with edges four "
                "times as long; \"uniform\": edges of one length; \"paper\": section 8 of the "
                "paper, not for a mesh.file"},
    {.name = "size",
     .type = Type::positive,
     .unit = "L",
     .if_absent = "1/20 of the diagonal of the sheet's bounding box: one inclusion then has about "
                  "as many triangles as in the paper's mesh. With more than about a hundred tips "
                  "it is smaller, so that each inclusion has about 1,500 triangles. \"coarse\" "
                  "takes four times this length, \"uniform\" 1/50 of the diagonal",
     .meaning = "edge length away from tips, at most as long as the membrane is across; not for "
                "\"paper\". The longest edge, which `mesh show` prints, is about this"},
    {.name = "tip_size",
     .type = Type::positive,
     .unit = "L",
     .if_absent = "1e-13; with more than 16 tips about 1e-5 of a short fibre's length: its error "
                  "stays far below that of mesh.size",
     .meaning = "smallest edge wanted; of \"graded\" and \"coarse\""},
    {.name = "grading",
     .type = Type::positive,
     .if_absent = "0.2",
     .meaning = "the exponent m of the refinement towards tips, at most 1; of \"graded\" and "
                "\"coarse\""},
    {.name = "chord_angle",
     .type = Type::positive,
     .unit = "degrees",
     .if_absent = "5, and a note then says how far chords and curves lie apart",
     .meaning = "by how many degrees a curve may turn on one chord, up to 45; not for a mesh.file. "
                "Answers and bounds are those of the membrane with chords. A circle of n chords "
                "has 6.6/n^2 less area: 0.13 % for 72 chords, 0.008 % for 288 (1.25 degrees)"},
    {.name = "align",
     .type = Type::structure,
     .form = "[[[x, y], [x, y]], ...]",
     .unit = "L",
     .meaning = "lines that mesh edges must follow, for example jumps of f; not for a mesh.file"},
    {.name = "file",
     .type = Type::structure,
     .form = "text, the name of a .msh",
     .meaning = "a mesh in place of [geometry]"},
    {.name = "groups",
     .type = Type::structure,
     .form = "table",
     .meaning = "what the groups of mesh.file mean, where it does not say so itself",
     .below = &group_keys},
    {.name = "tension",
     .type = Type::structure,
     .form = "{ SUBDOMAIN = tension }, each a tension as that of a region",
     .unit = "F/L",
     .if_absent = "1",
     .meaning = "T of the subdomains of mesh.file",
     .below = &law_keys,
     .many = true},
    {.name = "inclusions",
     .type = Type::structure,
     .form = "{ NAME = { tilt = true } }",
     .field = "inclusion_motions",
     .meaning = "those inclusions of mesh.file that do not simply move by u = A",
     .below = &motion_keys,
     .many = true},
};
constexpr Keys mesh_keys{v1::MeshOptions::descriptor, {mesh_rows}};

constexpr Key solver_rows[] = {
    {.name = "method",
     .type = Type::structure,
     .form = "\"active-set\" or \"uzawa\"",
     .if_absent = "\"active-set\"",
     .meaning = "\"active-set\": exact, a handful of steps; \"uzawa\": Algorithm 2 of the paper. "
                "It is `converged` only where the KKT residuals are at most 1e-4 (or "
                "kkt_tolerance) and no multiplier is held at its bound p"},
    {.name = "theta",
     .type = Type::structure,
     .form = "number > 0, or \"auto\"",
     .if_absent = "2, as in section 8 of the paper",
     .field = "uzawa.theta",
     .meaning = "the step of the iteration; \"auto\": 0.97 of the largest that converges",
     .only = "uzawa"},
    {.name = "epsilon",
     .type = Type::number,
     .if_absent = "1e-12",
     .field = "uzawa.epsilon",
     .meaning = "it stops where the relative change is below this",
     .only = "uzawa"},
    {.name = "p",
     .type = Type::number,
     .unit = "F/L",
     .if_absent = "1e5",
     .field = "uzawa.p",
     .meaning = "the bound on the multipliers",
     .only = "uzawa"},
    {.name = "max_iterations",
     .type = Type::count,
     .if_absent = "20000",
     .field = "uzawa.max_iterations",
     .meaning = "after which a load case is not converged",
     .only = "uzawa"},
    {.name = "mass",
     .type = Type::choice,
     .if_absent = "\"lumped\"",
     .field = "uzawa.mass",
     .meaning = "the mass matrix of interfaces; \"consistent\" is the paper's",
     .only = "uzawa"},
    {.name = "kkt_tolerance",
     .type = Type::number,
     .if_absent = "it stops by epsilon",
     .field = "uzawa.kkt_tolerance",
     .meaning = "it stops where every relative KKT residual is below this",
     .only = "uzawa"},
    {.name = "tolerance",
     .type = Type::number,
     .if_absent = "1e-12",
     .field = "active_set.tolerance",
     .meaning = "below which a relative jump or pressure counts as zero, at most 1e-3",
     .only = "active-set"},
    {.name = "max_steps",
     .type = Type::count,
     .if_absent = "1000",
     .field = "active_set.max_steps",
     .meaning = "after which a load case is not converged",
     .only = "active-set"},
};
constexpr Keys solver_keys{v1::Solver::descriptor, {solver_rows}};

constexpr Key accuracy_rows[] = {
    {.name = "energy",
     .type = Type::number,
     .form = "number, 1e-6 to 1",
     .if_absent = "needed without A",
     .meaning = "the width of the energy's interval over the energy, of each load case"},
    {.name = "A",
     .type = Type::number,
     .form = "number, 1e-6 to 1",
     .if_absent = "needed without energy",
     .field = "displacement",
     .meaning = "half the width of each A's interval, over the largest A of all inclusions"},
    {.name = "each_inclusion",
     .type = Type::boolean,
     .if_absent = "false",
     .meaning = "true: A is over the inclusion's own A, however small that is"},
    {.name = "max_triangles",
     .type = Type::count,
     .if_absent = "the server's limit",
     .meaning = "of a mesh"},
    {.name = "time",
     .type = Type::time,
     .if_absent = "none is too late",
     .meaning = "no stage begins later"},
    {.name = "keep_stages",
     .type = Type::boolean,
     .if_absent = "false",
     .meaning = "true: the meshes of all stages are kept on the server"},
};
constexpr Keys accuracy_keys{v1::Accuracy::descriptor, {accuracy_rows}};

constexpr Key unit_rows[] = {
    {.name = "length",
     .meaning = "of coordinates and u, such as \"mm\". A note below the answers warns if u is "
                "above a tenth of the sheet's smaller side: the equation holds for small slopes"},
    {.name = "force",
     .meaning = "such as \"N\". Tables, figures, result files and ParaView then show T in N/mm, "
                "f in N/mm^2, contact pressure in N/mm, the energy in N mm; without them `-`. "
                "Write both: a note says which is missing"},
};
constexpr Keys unit_keys{v1::Units::descriptor, {unit_rows}};

constexpr Key array_rows[] = {
    {.name = "file",
     .type = Type::structure,
     .form = "text",
     .meaning = "an HDF5 file",
     .need = "name an HDF5 file"},
    {.name = "dataset",
     .type = Type::structure,
     .form = "text",
     .meaning = "of float64, in the order of the mesh",
     .need = "name the dataset in the file, as \"/f\""},
    {.name = "per",
     .type = Type::structure,
     .form = "\"triangle\" or \"node\"",
     .meaning = "what has a value each",
     .need = "write per = \"triangle\" or per = \"node\""},
};
constexpr Keys array_keys{v1::Force::Array::descriptor, {array_rows}};

constexpr Key point_force_rows[] = {
    {.name = "at",
     .type = Type::point,
     .unit = "L",
     .meaning = "inside the membrane, not on a crack; on an inclusion it acts on the inclusion",
     .need = "write [x, y], where the force acts"},
    {.name = "value",
     .type = Type::number,
     .unit = "F",
     .meaning = "positive in the direction of u",
     .need = "write the force, a number"},
};
constexpr Keys point_force_keys{v1::PointForce::descriptor, {point_force_rows}};

constexpr Key load_rows[] = {
    {.name = "name",
     .meaning = "unique: letters, digits, '_', '.', '-' and spaces",
     .need = "give the load case a name"},
    {.name = "f",
     .type = Type::structure,
     .form = "number, expression in x and y, { SUBDOMAIN = number }, or { file = \"f.h5\", "
             "dataset = \"/f\", per = \"triangle\" }",
     .unit = "F/L^2",
     .if_absent = "needed without any other load",
     .field = "force",
     .meaning = "the load, positive in the direction of u. An expression: numbers, x, y, _pi, _e; "
                "+ - * / ^, < <= > >= == !=, &&, ||, a ? b : c; sin cos tan asin acos atan sinh "
                "cosh tanh asinh acosh atanh exp log (or ln) log2 log10 sqrt abs sign rint floor "
                "ceil atan2 min max sum avg. It is integrated to min(1e-5, 0.1 / triangles) of its "
                "absolute integral; what is proved to be unknown of it widens the bounds, and a "
                "warning says how much where that matters",
     .below = &array_keys},
    {.name = "boundary_value",
     .type = Type::expression,
     .unit = "L",
     .if_absent = "0",
     .meaning = "g_D: u on the boundary"},
    {.name = "traction",
     .type = Type::expression,
     .unit = "F/L",
     .if_absent = "0",
     .meaning = "g_N = T du/dn on the parts in geometry.neumann"},
    {.name = "point_forces",
     .type = Type::list,
     .form = "[{ at = [x, y], value = F }, ...]",
     .meaning = "forces at points",
     .below = &point_force_keys,
     .many = true},
    {.name = "inclusion_forces",
     .type = Type::structure,
     .form = "{ INCLUSION = number }",
     .unit = "F",
     .meaning = "forces on inclusions, positive in the direction of u"},
    {.name = "inclusion_moments",
     .type = Type::structure,
     .form = "{ INCLUSION = [Mx, My] }",
     .unit = "F L",
     .meaning = "moments on inclusions that tilt, about (x0, y0), the middle of the bounding box; "
                "their work is Mx Bx + My By, u = A + Bx (x - x0) + By (y - y0) along it. A force "
                "F at a point p of it has the moment F (p - (x0, y0))"},
};
constexpr Keys load_keys{v1::LoadCase::descriptor, {load_rows}};

constexpr Key job_rows[] = {
    {.name = "priority",
     .type = Type::choice,
     .if_absent = "\"normal\"",
     .meaning = "which jobs run first: \"interactive\" where a user waits, \"bulk\" when nothing "
                "else does"},
    {.name = "queue_timeout",
     .type = Type::time,
     .if_absent = "the server's limit",
     .meaning = "longest time until it starts"},
    {.name = "run_timeout",
     .type = Type::time,
     .if_absent = "the server's limit",
     .meaning = "longest time from its start to its end"},
};
constexpr Keys job_keys{v1::JobSpec::descriptor, {job_rows}};

constexpr Key output_rows[] = {
    {.name = "fields",
     .type = Type::structure,
     .form = "true or false",
     .if_absent = "false",
     .meaning = "true: u on every node is kept, for figures of the membrane and export"},
    {.name = "bounds",
     .type = Type::structure,
     .form = "true or false",
     .if_absent = "true",
     .meaning = "false: answers have no bounds of their errors; many small loads take a third less "
                "time"},
};
constexpr Keys output_keys{v1::JobSpec::descriptor, {output_rows}};

constexpr Key case_rows[] = {
    {.name = "title", .meaning = "for people, at most 200 bytes"},
    {.name = "geometry",
     .type = Type::structure,
     .form = "table",
     .if_absent = "needed without mesh.file",
     .meaning = "the membrane and what is in it",
     .below = &geometry_keys},
    {.name = "mesh",
     .type = Type::structure,
     .form = "table",
     .field = "options",
     .meaning = "how fine its mesh is, or a mesh from a file",
     .below = &mesh_keys},
    {.name = "solver",
     .type = Type::structure,
     .form = "table",
     .meaning = "how load cases are solved",
     .below = &solver_keys},
    {.name = "accuracy",
     .type = Type::table,
     .if_absent = "one mesh, no refinement",
     .meaning = "solves on finer and finer meshes until the bounds of the errors are this close",
     .below = &accuracy_keys},
    {.name = "units",
     .type = Type::table,
     .if_absent = "none",
     .meaning = "names of your units; nothing is converted",
     .below = &unit_keys},
    {.name = "load",
     .type = Type::structure,
     .form = "a table for each",
     .field = "load_cases",
     .meaning = "all that acts on the membrane together; any number, with different names",
     .below = &load_keys,
     .many = true},
    {.name = "job",
     .type = Type::table,
     .field = ".",
     .meaning = "when it runs, and how long it may",
     .below = &job_keys},
    {.name = "output",
     .type = Type::structure,
     .form = "table",
     .meaning = "what is kept beside the traces along interfaces",
     .below = &output_keys},
};

}  // namespace

constexpr Keys case_keys{v1::JobSpec::descriptor, {case_rows}};
constexpr Keys msh_keys{v1::JobSpec::descriptor, {std::span(case_rows).subspan(2, 1)}};
static_assert(case_rows[2].name == "mesh");

const Key* Keys::find(std::string_view name) const {
  for (const std::span<const Key> group : groups)
    for (const Key& key : group)
      if (key.name == name) return &key;
  return nullptr;
}

std::vector<const Key*> Keys::known() const {
  std::vector<const Key*> found;
  for (const std::span<const Key> group : groups)
    for (const Key& key : group)
      if (key.type != Type::refused) found.push_back(&key);
  return found;
}

const google::protobuf::FieldDescriptor* Keys::field(std::string_view path) const {
  const google::protobuf::Descriptor* in = message();
  const google::protobuf::FieldDescriptor* found = nullptr;
  while (in && !path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    found = in->FindFieldByName(std::string(path.substr(0, dot)));
    in = found ? found->message_type() : nullptr;
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return path.empty() ? found : nullptr;
}

std::vector<std::string> choices(const google::protobuf::EnumDescriptor& values) {
  const std::size_t prefix = values.FindValueByNumber(0)->name().rfind("UNSPECIFIED");
  std::vector<std::string> names;
  for (int i = 0; i < values.value_count(); ++i) {
    if (values.value(i)->number() == 0) continue;
    std::string name = values.value(i)->name().substr(prefix);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace anticrack::casefile
