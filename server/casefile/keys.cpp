// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/keys.hpp"

#include <algorithm>
#include <cctype>

namespace anticrack::casefile {
namespace rows {

using enum Type;

constexpr Part operator""_form(const char* text, std::size_t size) {
  return {&Key::form, {text, size}};
}
constexpr Part operator""_unit(const char* text, std::size_t size) {
  return {&Key::unit, {text, size}};
}
constexpr Part operator""_absent(const char* text, std::size_t size) {
  return {&Key::if_absent, {text, size}};
}
constexpr Part operator""_field(const char* text, std::size_t size) {
  return {&Key::field, {text, size}};
}
constexpr Part operator""_need(const char* text, std::size_t size) {
  return {&Key::need, {text, size}};
}
constexpr Part operator""_only(const char* text, std::size_t size) {
  return {&Key::only, {text, size}};
}

constexpr Part points_form = "[[x, y], [x, y], ...]"_form;

constexpr Key curve_rows[] = {
    {"points", structure, points_form, "L"_unit, "straight between these points"},
    {"arc", structure, "[from, through, to]"_form, "L"_unit,
     "an arc of a circle through three points"},
    {"spline", structure, points_form, "L"_unit, "a smooth line through the points, at least 3"},
};

constexpr Key segment_rows[] = {
    {"center", point, "L"_unit, "the middle of a straight line; with angle and length",
     "line.segment.center"_field},
    {"angle", number, "degrees"_unit,
     "of a straight line, counterclockwise from the x axis; with center", "0"_absent,
     "line.segment.angle"_field},
    {"length", positive, "L"_unit, "of a straight line; with center", "needed with center"_absent,
     "line.segment.length"_field},
};

constexpr Key circle_rows[] = {
    {"center", point, "L"_unit, "its middle", "write [x, y]"_need},
    {"radius", positive, "L"_unit, "its radius", "write its radius"_need},
};
constexpr Keys circle_keys{v1::Circle::descriptor, {circle_rows}};

constexpr Key outline_rows[] = {
    {"circle", table, "{ center = [x, y], radius = r }"_form, "a circle", "outline.circle"_field,
     &circle_keys},
    {"points", structure, points_form, "L"_unit,
     "a polygon; its last point is joined to its first"},
    {"spline", structure, points_form, "L"_unit,
     "a smooth closed line through the points, at least 3"},
};

constexpr Key side_rows[] = {
    {"name", "for geometry.neumann",
     "side-1, side-2, ... by its place, also of a polygon's edges"_absent},
};
constexpr Keys side_keys{v1::Side::descriptor, {side_rows, curve_rows, segment_rows}};

constexpr Key hole_rows[] = {
    {"name", "for geometry.neumann", "hole-1, hole-2, ... by its place"_absent},
};
constexpr Keys hole_keys{v1::Hole::descriptor, {hole_rows, outline_rows}};

constexpr Key interface_rows[] = {
    {"name", "what results call it",
     "\"interface\" if it is the only one, else \"interface-2\", ..."_absent},
    {"closed", boolean,
     "true: a ring, its last point is joined to its first; of points and splines", "false"_absent},
};
constexpr Keys interface_keys{v1::InterfaceCurve::descriptor, {interface_rows, curve_rows}};

constexpr Key motion_rows[] = {
    {"tilt", boolean,
     "true: a straight inclusion moves by u = A + B s, s from its middle, any other as a thin "
     "rigid plate, u = A + Bx (x - x0) + By (y - y0) about the middle of its bounding box. "
     "Inclusions "
     "that share nodes are one body, which tilts if all of them do",
     "false: u = A"_absent},
    {"fixed", number, "L"_unit,
     "u of an inclusion that is held; it does not tilt, and a force on it is refused",
     "it is not held"_absent},
};
constexpr Keys motion_keys{v1::InclusionMotion::descriptor, {motion_rows}};

constexpr Key inclusion_rows[] = {
    {"name", "unique among inclusions and cracks", "give the inclusion a name"_need},
    {"from", point, "L"_unit,
     "where it begins, a point of an interface. In place of from and to it may have a line of its "
     "own, an interface with its name: points, arc, spline, or center, angle and length",
     "needed unless it has a line of its own"_absent, "part.from"_field},
    {"to", point, "L"_unit, "where it ends, a point of the same interface",
     "needed with from"_absent, "part.to"_field},
    {"delaminated", structure,
     "true, false, \"left\", \"right\", or a list of [from, to]: points, or stretches of "
     "its length such as [0.5, 1.0]"_form,
     "which part of it comes off; the rest is bonded", "true"_absent, "delaminated_parts"_field},
    {"side", choice,
     "the side that comes off, seen walking along it; beside a list or true in delaminated",
     "\"right\", of a part of an interface its minus side"_absent, "delaminated_side"_field},
    {"contact", refused,
     "belongs to [[geometry.crack]]; an inclusion has delaminated = true or false"},
    motion_rows[0],
    motion_rows[1],
};
constexpr Keys inclusion_keys{v1::Inclusion::descriptor,
                              {inclusion_rows, curve_rows, segment_rows}};

constexpr const char* not_rigid =
    "belongs to [[geometry.inclusion]]; nothing rigid lies on a crack, so remove it";
constexpr Key crack_rows[] = {
    {"name", "unique among inclusions and cracks", "give the crack a name"_need},
    inclusion_rows[1],
    inclusion_rows[2],
    {"contact", boolean, "false: its faces are free, as in mode III, and [u] has either sign",
     "true: [u] >= 0"_absent},
    {"tilt", refused, not_rigid},
    {"fixed", refused, not_rigid},
    {"side", refused,
     "belongs to [[geometry.inclusion]]; the plus side of a crack is on its left, so write it the "
     "other way round"},
};
constexpr Keys crack_keys{v1::Crack::descriptor, {crack_rows, curve_rows, segment_rows}};

constexpr Key law_rows[] = {
    {"along", expression, "F/L"_unit, "the tension in the direction of angle",
     "write the tension in the direction of angle, a number or an expression"_need},
    {"across", expression, "F/L"_unit, "the tension perpendicular to it", "as along"_absent},
    {"angle", number, "degrees"_unit, "counterclockwise from the x axis", "0"_absent},
};
constexpr Keys law_keys{v1::Tension::descriptor, {law_rows}};

constexpr Part tension_form = "number > 0, expression in x and y, or { along, across, angle }"_form;

constexpr Key region_rows[] = {
    {"name", "of the subdomain, else omega1, omega2, ...; for load.f",
     "give the region a name"_need},
    {"at", point, "L"_unit,
     "any point inside it. In place of it an outline, circle, points or spline: the inside without "
     "regions that lie in it",
     "needed without an outline"_absent},
    {"tension", structure, tension_form, "F/L"_unit,
     "T of -div(T grad u) = f. Of a table T is the symmetric matrix with the eigenvalue along in "
     "the direction of angle and across perpendicular to it. Each triangle has the mean of each; "
     "bounds are those of T itself",
     "1, with a note where other regions give one, or none does though there are units"_absent,
     &law_keys},
};
constexpr Keys region_keys{v1::Region::descriptor, {region_rows, outline_rows}};

constexpr Key geometry_rows[] = {
    {"boundary", structure, "[[x, y], [x, y], ...], or a table for each side"_form, "L"_unit,
     "a polygon, or sides, each of which begins where the one before it ends",
     "write [[x, y], [x, y], ...], or [[geometry.boundary]] for each side"_need,
     EachOf{&side_keys}},
    {"hole", structure, "a table for each"_form,
     "part of the boundary; touches neither the rest of it nor another hole", "holes"_field,
     EachOf{&hole_keys}},
    {"interface", structure, "[[x, y], [x, y], ...], or a table for each"_form, "L"_unit,
     "lines for inclusions and cracks to lie on; the plus side is on their left", "none"_absent,
     "interfaces"_field, EachOf{&interface_keys}},
    {"inclusion", structure, "a table for each"_form, "thin rigid inclusions", "inclusions"_field,
     EachOf{&inclusion_keys}},
    {"crack", structure, "a table for each"_form, "cracks", "cracks"_field, EachOf{&crack_keys}},
    {"neumann", structure,
     "list of names of sides and holes, or of [from, to] on the outer boundary walked "
     "counterclockwise; or \"all\""_form,
     "where a traction acts. A straight side written clockwise is refused, as it would mean the "
     "rest of the boundary",
     "u = g_D on all of the boundary"_absent},
    {"region", structure, "a table for each"_form, "names a subdomain and gives it its tension",
     "regions"_field, EachOf{&region_keys}},
};
constexpr Keys geometry_keys{v1::Geometry::descriptor, {geometry_rows}};

constexpr Key group_rows[] = {
    {"curve", structure, "{ TAG = \"meaning\" }"_form,
     "of physical curves by their number: \"dirichlet\", \"dirichlet:NAME\", \"neumann\", "
     "\"neumann:NAME\", \"crack\", \"crack:NAME\", \"free\", \"free:NAME\", \"inclusion:NAME\", "
     "\"delaminated:NAME\" or \"glue\""},
    {"surface", structure, "{ TAG = \"name\" }"_form,
     "the names of subdomains by the number of their physical surface"},
};
constexpr Keys group_keys{v1::MeshOptions::descriptor, {group_rows}};

constexpr Key mesh_rows[] = {
    {"preset", choice,
     "\"graded\": bisected towards every tip; \"coarse\": the same with edges four times as long; "
     "\"uniform\": edges of one length; \"paper\": section 8 of the paper, not for a mesh.file",
     "\"graded\", with [accuracy] \"coarse\""_absent},
    {"size", positive, "L"_unit,
     "edge length away from tips, at most as long as the membrane is across; not for \"paper\". "
     "The longest edge, which `mesh show` prints, is about this",
     "1/20 of the diagonal of the sheet's bounding box: one inclusion then has about as "
     "many triangles as in the paper's mesh. With more than about a hundred tips it is "
     "smaller, so that each inclusion has about 1,500 triangles. \"coarse\" takes four "
     "times this length, \"uniform\" 1/50 of the diagonal"_absent},
    {"tip_size", positive, "L"_unit, "smallest edge wanted; of \"graded\" and \"coarse\"",
     "1e-13; with more than 16 tips about 1e-5 of a short fibre's length: its error stays "
     "far below that of mesh.size"_absent},
    {"grading", positive,
     "the exponent m of the refinement towards tips, at most 1; of \"graded\" and \"coarse\"",
     "0.2"_absent},
    {"chord_angle", positive, "degrees"_unit,
     "by how many degrees a curve may turn on one chord, up to 45; not for a mesh.file. Answers "
     "and bounds are those of the membrane with chords, which leave as much area on one side of "
     "their curve as on the other and are shorter towards tips. What curves would change is "
     "estimated (`chords +-`) and falls as the third power of the angle: the energy of a disc is "
     "off by 0.0026 % with 72 chords, by 0.00005 % with 288 (1.25 degrees)",
     "5, and a note then says how far chords and curves lie apart; with [accuracy] less where "
     "chords would change more than about a tenth of it"_absent},
    {"align", structure, "[[[x, y], [x, y]], ...]"_form, "L"_unit,
     "lines that mesh edges must follow, for example jumps of f; not for a mesh.file"},
    {"file", structure, "text, the name of a .msh"_form, "a mesh in place of [geometry]"},
    {"groups", structure, "table"_form,
     "what the groups of mesh.file mean, where it does not say so itself", &group_keys},
    {"tension", structure, "{ SUBDOMAIN = tension }, each a tension as that of a region"_form,
     "F/L"_unit, "T of the subdomains of mesh.file", "1"_absent, EachOf{&law_keys}},
    {"inclusions", structure, "{ NAME = { tilt = true } }"_form,
     "those inclusions of mesh.file that do not simply move by u = A", "inclusion_motions"_field,
     EachOf{&motion_keys}},
};
constexpr Keys mesh_keys{v1::MeshOptions::descriptor, {mesh_rows}};

constexpr Key solver_rows[] = {
    {"method", structure, "\"active-set\" or \"uzawa\""_form,
     "\"active-set\": exact, a handful of steps; \"uzawa\": Algorithm 2 of the paper. It is "
     "`converged` only where the KKT residuals are at most 1e-4 (or kkt_tolerance) and no "
     "multiplier is held at its bound p",
     "\"active-set\""_absent},
    {"theta", structure, "number > 0, or \"auto\""_form,
     "the step of the iteration; \"auto\": 0.97 of the largest that converges",
     "2, as in section 8 of the paper"_absent, "uzawa.theta"_field, "uzawa"_only},
    {"epsilon", number, "it stops where the relative change is below this", "1e-12"_absent,
     "uzawa.epsilon"_field, "uzawa"_only},
    {"p", number, "F/L"_unit, "the bound on the multipliers", "1e5"_absent, "uzawa.p"_field,
     "uzawa"_only},
    {"max_iterations", count, "after which a load case is not converged", "20000"_absent,
     "uzawa.max_iterations"_field, "uzawa"_only},
    {"mass", choice, "the mass matrix of interfaces; \"consistent\" is the paper's",
     "\"lumped\""_absent, "uzawa.mass"_field, "uzawa"_only},
    {"kkt_tolerance", number, "it stops where every relative KKT residual is below this",
     "it stops by epsilon"_absent, "uzawa.kkt_tolerance"_field, "uzawa"_only},
    {"tolerance", number, "below which a relative jump or pressure counts as zero, at most 1e-3",
     "1e-12"_absent, "active_set.tolerance"_field, "active-set"_only},
    {"max_steps", count, "after which a load case is not converged", "1000"_absent,
     "active_set.max_steps"_field, "active-set"_only},
};
constexpr Keys solver_keys{v1::Solver::descriptor, {solver_rows}};

constexpr Key accuracy_rows[] = {
    {"energy", number, "number, 1e-6 to 1"_form,
     "the width of the energy's interval over the energy, of each load case",
     "needed without A and A_estimated"_absent},
    {"A", number, "number, 1e-6 to 1"_form,
     "half the width of each A's interval, over that A; or, of an A near 0, its largest amount "
     "over "
     "A_scale",
     "needed without energy and A_estimated"_absent, "displacement"_field},
    {"A_estimated", number, "number, 1e-6 to 1"_form,
     "as A, by an estimate of the error, A_error_probable: much sooner reached, and no proof",
     "proof alone counts"_absent, "displacement_estimated"_field},
    {"largest", boolean, "true: A is over the largest A of all inclusions, not each over its own",
     "false"_absent},
    {"max_triangles", count, "of a mesh", "the server's limit"_absent},
    {"time", time, "no stage begins later", "none is too late"_absent},
    {"keep_stages", boolean, "true: the meshes of all stages are kept on the server",
     "false"_absent},
};
constexpr Keys accuracy_keys{v1::Accuracy::descriptor, {accuracy_rows}};

constexpr Key path_rows[] = {
    {"interface",
     "the line of the path: the name of an interface, or of an inclusion or crack that has a line "
     "of its own",
     "name an interface, inclusion or crack"_need},
    {"from", point, "L"_unit, "where the stretch begins that holds at first",
     "write [x, y], a point of the line"_need},
    {"to", point, "L"_unit, "where it ends", "write [x, y], a point of the line"_need},
    {"Gc", expression, "F"_unit, "what growth costs per length, above 0 on the whole path",
     "write a number above 0, or an expression in x and y"_need, "toughness"_field},
};
constexpr Keys path_keys{v1::Growth::Path::descriptor, {path_rows}};

constexpr Key growth_rows[] = {
    {"path", list, "a table for each"_form,
     "a stretch that holds at first, and along which fronts grow from where it meets what is open. "
     "[geometry] has it as what it becomes, delaminated or a crack",
     "write [[growth.path]] with interface, from, to and Gc"_need, "paths"_field,
     EachOf{&path_keys}},
    {"inclusion", "increased is the displacement of this inclusion, in place of the load",
     "the load is increased"_absent},
    {"positions", count, "about so many on all paths together, 2 to 1,000", "200"_absent},
    {"final", count,
     "so many of them, 2 to 1,000, are solved again, each on a mesh bisected for it, with bounds "
     "of "
     "G1 and of the load between them",
     "none"_absent, "final_positions"_field},
    {"final_error", positive,
     "half the width of the bounds of G1 over G1 at which bisection ends, 0.001 to 1",
     "0.05"_absent},
    {"dead",
     "the name of a load that acts beside each of the others and is not scaled; not with inclusion",
     "all that acts is scaled"_absent},
    {"membranes", count,
     "of so many positions u is kept, evenly spaced along the way, 2 to 100; takes output.fields",
     "of the first, the last, and where fronts begin to run or stop"_absent},
};
constexpr Keys growth_keys{v1::Growth::descriptor, {growth_rows}};

constexpr Key unit_rows[] = {
    {"length",
     "of coordinates and u, such as \"mm\". A note below the answers warns if u is above a tenth "
     "of the sheet's smaller side: the equation holds for small slopes"},
    {"force",
     "such as \"N\". Tables, figures, result files and ParaView then show T in N/mm, f in N/mm^2, "
     "contact pressure in N/mm, the energy in N mm; without them `-`. Write both: a note says "
     "which is missing"},
};
constexpr Keys unit_keys{v1::Units::descriptor, {unit_rows}};

constexpr Key array_rows[] = {
    {"file", structure, "text"_form, "an HDF5 file", "name an HDF5 file"_need},
    {"dataset", structure, "text"_form, "of float64, in the order of the mesh",
     "name the dataset in the file, as \"/f\""_need},
    {"per", structure, "\"triangle\" or \"node\""_form, "what has a value each",
     "write per = \"triangle\" or per = \"node\""_need},
};
constexpr Keys array_keys{v1::Force::Array::descriptor, {array_rows}};

constexpr Key point_force_rows[] = {
    {"at", point, "L"_unit,
     "inside the membrane, not on a crack; on an inclusion it acts on the inclusion",
     "write [x, y], where the force acts"_need},
    {"value", number, "F"_unit, "positive in the direction of u", "write the force, a number"_need},
};
constexpr Keys point_force_keys{v1::PointForce::descriptor, {point_force_rows}};

constexpr Key load_rows[] = {
    {"name", "unique: letters, digits, '_', '.', '-' and spaces", "give the load case a name"_need},
    {"f", structure,
     "number, expression in x and y, { SUBDOMAIN = number }, or { file = \"f.h5\", "
     "dataset = \"/f\", per = \"triangle\" }"_form,
     "F/L^2"_unit,
     "the load, positive in the direction of u. An expression: numbers, x, y, _pi, _e; + - * / ^, "
     "< <= > >= == !=, &&, ||, a ? b : c; sin cos tan asin acos atan sinh cosh tanh asinh acosh "
     "atanh exp log (or ln) log2 log10 sqrt abs sign rint floor ceil atan2 min max sum avg. It is "
     "integrated to min(1e-5, 0.1 / triangles) of its absolute integral; what is proved to be "
     "unknown of it widens the bounds, and a warning says how much where that matters",
     "needed without any other load"_absent, "force"_field, &array_keys},
    {"boundary_value", expression, "L"_unit, "g_D: u on the boundary", "0"_absent},
    {"traction", expression, "F/L"_unit, "g_N = T du/dn on the parts in geometry.neumann",
     "0"_absent},
    {"point_forces", list, "[{ at = [x, y], value = F }, ...]"_form, "forces at points",
     EachOf{&point_force_keys}},
    {"inclusion_forces", structure, "{ INCLUSION = number }"_form, "F"_unit,
     "forces on inclusions, positive in the direction of u"},
    {"inclusion_moments", structure, "{ INCLUSION = [Mx, My] }"_form, "F L"_unit,
     "moments on inclusions that tilt, about (x0, y0), the middle of the bounding box; their work "
     "is Mx Bx + My By, u = A + Bx (x - x0) + By (y - y0) along it. A force F at a point p of it "
     "has the moment F (p - (x0, y0))"},
};
constexpr Keys load_keys{v1::LoadCase::descriptor, {load_rows}};

constexpr Key job_rows[] = {
    {"priority", choice,
     "which jobs run first: \"interactive\" where a user waits, \"bulk\" when nothing else does",
     "\"normal\""_absent},
    {"queue_timeout", time, "longest time until it starts", "the server's limit"_absent},
    {"run_timeout", time, "longest time from its start to its end", "the server's limit"_absent},
};
constexpr Keys job_keys{v1::JobSpec::descriptor, {job_rows}};

constexpr Key probe_rows[] = {
    {"name", "a letter, then at most 63 letters, digits, '_', '.' or '-'",
     "probe-1, probe-2, ... by its place"_absent},
    {"at", point, "L"_unit,
     "one point, in the membrane or on its boundary; on an interface it has u of both sides",
     "a line"_absent, "from"_field},
    {"from", point, "L"_unit, "of a line: its first point", "one point, `at`"_absent},
    {"to", point, "L"_unit, "of a line: its last point", "one point, `at`"_absent},
    {"points", count, "of a line, evenly spaced, its ends among them: 2 to 1,000, as all probes",
     "one point, `at`"_absent},
};
constexpr Keys probe_keys{v1::Probe::descriptor, {probe_rows}};

constexpr Key output_rows[] = {
    {"fields", structure, "true or false"_form,
     "true: u on every node is kept, for figures of the membrane and export", "false"_absent},
    {"balanced_flux", structure, "true or false"_form,
     "true: the flux from which bounds are made is kept, which is in equilibrium with the load on "
     "every triangle",
     "false"_absent},
    {"bounds", structure, "true or false"_form,
     "false: answers have no bounds of their errors; many small loads take a third less time",
     "true"_absent},
    {"probe", list, "a table for each"_form, "points and lines at which u is told; not of a sweep",
     "probes"_field, EachOf{&probe_keys}},
};
constexpr Keys output_keys{v1::JobSpec::descriptor, {output_rows}};

constexpr Key case_rows[] = {
    {"title", "for people, at most 200 bytes"},
    {"geometry", structure, "table"_form, "the membrane and what is in it",
     "needed without mesh.file"_absent, &geometry_keys},
    {"mesh", structure, "table"_form, "how fine its mesh is, or a mesh from a file",
     "options"_field, &mesh_keys},
    {"solver", structure, "table"_form, "how load cases are solved", &solver_keys},
    {"accuracy", table,
     "solves on finer and finer meshes until the bounds of the errors are this close",
     "one mesh, no refinement"_absent, &accuracy_keys},
    {"growth", table, "cracks and delaminations grow under each load, which is scaled",
     "nothing grows"_absent, &growth_keys},
    {"units", table, "names of your units; nothing is converted", "none"_absent, &unit_keys},
    {"load", structure, "a table for each"_form,
     "all that acts on the membrane together; any number, with different names", "load_cases"_field,
     EachOf{&load_keys}},
    {"job", table, "when it runs, and how long it may", "."_field, &job_keys},
    {"output", structure, "table"_form, "what is kept beside the traces along interfaces",
     &output_keys},
};

}  // namespace rows

constexpr Keys case_keys{v1::JobSpec::descriptor, {rows::case_rows}};
constexpr Keys msh_keys{v1::JobSpec::descriptor, {std::span(rows::case_rows).subspan(2, 1)}};
static_assert(rows::case_rows[2].name == "mesh");

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
