// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

#include <algorithm>
#include <optional>
#include <unordered_set>

#include "words/nearest.hpp"

namespace anticrack::casefile {
namespace {

constexpr const char* force_cure =
    "write a number, an expression in x and y in quotes, {region = number} or {file = \"f.h5\", "
    "dataset = \"/f\", per = \"triangle\"}";

// A region may be called "file" too, but its value is a number.
bool names_a_file(const toml::table& table) {
  const toml::node* file = table.get("file");
  return table.contains("dataset") || table.contains("per") || (file && !file->is_number());
}

ForceFile read_force_file(const Section& section) {
  ForceFile file;
  file.path = section.need_text("file", "name an HDF5 file");
  file.dataset = section.need_text("dataset", "name the dataset in the file, as \"/f\"");
  section.need("per", "write per = \"triangle\" or per = \"node\"");
  file.per_triangle = *section.choice("per", {"triangle", "node"}) == 0;
  return file;
}

// Empty where the values are not in a file.
std::optional<ForceFile> read_force(const Section& section, v1::Force& force) {
  const toml::node& node = section.need("f", force_cure);
  const toml::table* table = node.as_table();
  if (table && names_a_file(*table)) {
    ForceFile file = read_force_file(*section.section("f", {"file", "dataset", "per"}));
    force.mutable_array()->set_per_triangle(file.per_triangle);
    return file;
  }
  if (const auto expression = node.value_exact<std::string>()) {
    force.set_expression(*expression);
  } else if (table) {
    auto& values = *force.mutable_per_region()->mutable_values();
    for (const auto& [region, value] : section.numbers("f", "write one number for each region"))
      values[region] = value;
  } else {
    force.set_constant(number_of(node, section.path_of("f"), force_cure));
  }
  return std::nullopt;
}

void read_point_forces(const Section& section, const std::string& field, v1::LoadCase& load,
                       Spots& spots) {
  for (const Section& force : section.sections("point_forces", {"at", "value"})) {
    note(force, entry_field(field + ".point_forces", load.point_forces().size()), spots);
    v1::PointForce& point_force = *load.add_point_forces();
    set(*point_force.mutable_at(),
        point_of(force.need("at", "write [x, y], where the force acts"), force.path_of("at")));
    force.need("value", "write the force, a number");
    point_force.set_value(*force.number("value"));
  }
}

void read_moments(const Section& section, const std::string& field, v1::LoadCase& load,
                  Spots& spots) {
  const char* cure = "write inclusion = [Mx, My] for each of them";
  for (const auto& [name, entry] : section.entries("inclusion_moments", cure)) {
    const std::string key = section.path_of("inclusion_moments", name);
    const auto [x, y] = pair_of(*entry, key, "a moment", cure);
    v1::InclusionMoment& moment = (*load.mutable_inclusion_moments())[name];
    moment.set_x(x);
    moment.set_y(y);
    set_entry(spots, field + ".inclusion_moments", name, spot_of(*entry, key));
  }
}

/// Names that loads of a geometry may use.
struct Names {
  template <class Owners>
  explicit Names(const Owners& owners) {
    for (const auto& owner : owners) list.push_back(owner.name());
    set.insert(list.begin(), list.end());
  }

  std::vector<std::string> list;
  std::unordered_set<std::string> set;
};

// What a load names must be in the geometry; what is in a .msh file is known later.
void check_names(const Section& section, const char* key, const std::string& what,
                 const Names& known) {
  for (const auto& [name, entry] : section.entries(key, "")) {
    // Where a subdomain has no region it is omega1, omega2, ...: only its mesh tells how many.
    if (known.set.contains(name) || (what == "region" && name.starts_with("omega"))) continue;
    std::vector<std::string> sorted = known.list;
    std::ranges::sort(sorted);
    const auto twice = std::ranges::adjacent_find(sorted);
    throw Error(spot_of(*entry, section.path_of(key, name)),
                "there is no " + what + " of this name; " +
                    (sorted.empty() ? "name one by [[geometry." + what + "]]"
                     : twice != sorted.end()
                         ? "two " + what + "s are called \"" + *twice + "\": give each its own name"
                         : words::suggestion(name, known.list)));
  }
}

/// What of a geometry or a mesh's options loads are checked against.
struct Subjects {
  explicit Subjects(const v1::CreateMeshRequest& mesh)
      : geometry(mesh.has_geometry() ? &mesh.geometry() : nullptr),
        regions(mesh.geometry().regions()),
        inclusions(mesh.geometry().inclusions()) {
    for (const v1::Inclusion& inclusion : mesh.geometry().inclusions()) {
      if (inclusion.has_fixed()) held.insert(inclusion.name());
      if (!inclusion.tilt()) level.insert(inclusion.name());
    }
    for (const auto& [name, motion] : mesh.options().inclusion_motions())
      if (motion.has_fixed()) held.insert(name);
  }

  const v1::Geometry* geometry;  ///< null for a mesh from a file
  Names regions, inclusions;
  std::unordered_set<std::string> held, level;  ///< by fixed; without tilt
};

void check_names(const Section& section, const v1::LoadCase& load, const Subjects& subjects) {
  const v1::Geometry& geometry = *subjects.geometry;
  if (!load.traction().empty() && load.traction() != "0" && geometry.neumann().empty() &&
      geometry.neumann_sides().empty()) {
    throw Error(section.spot_of("traction"),
                "nothing has a traction, as no part of the boundary is in geometry.neumann; name "
                "its sides or holes there");
  }
  if (load.force().has_per_region()) check_names(section, "f", "region", subjects.regions);
  check_names(section, "inclusion_forces", "inclusion", subjects.inclusions);
  check_names(section, "inclusion_moments", "inclusion", subjects.inclusions);
  for (const auto& [name, entry] : section.entries("inclusion_moments", "")) {
    if (!subjects.level.contains(name)) continue;
    throw Error(section.spot_of("inclusion_moments"),
                "the inclusion \"" + name +
                    "\" does not tilt, so a moment on it does nothing; write tilt = true in its "
                    "[[geometry.inclusion]], or leave the moment out");
  }
}

// The server takes it, as its work belongs to the energy, but nothing moves by it.
void refuse_force_on_held(const Section& section, const Subjects& subjects) {
  for (const auto& [name, entry] : section.entries("inclusion_forces", "")) {
    if (!subjects.held.contains(name)) continue;
    throw Error(
        spot_of(*entry, section.path_of("inclusion_forces", name)),
        "the inclusion is held by its key fixed, so a force on it moves nothing; leave one of "
        "the two out");
  }
}

void read_load(const Section& section, std::size_t index, const Subjects& subjects, Case& result) {
  const std::string field = entry_field("load_cases", index);
  Spots& spots = result.spots;
  v1::LoadCase& load = *result.job.add_load_cases();
  load.set_name(section.need_text("name", "give the load case a name"));
  load.set_boundary_value(section.expression("boundary_value").value_or(""));
  load.set_traction(section.expression("traction").value_or(""));
  note(section, field, spots);
  read_point_forces(section, field, load, spots);
  add_numbers(section, "inclusion_forces", "write inclusion = number for each of them",
              field + ".inclusion_forces", *load.mutable_inclusion_forces(), spots);
  read_moments(section, field, load, spots);

  // Without any other load, a missing f is most likely forgotten.
  const bool loaded = !load.boundary_value().empty() || !load.traction().empty() ||
                      !load.point_forces().empty() || !load.inclusion_forces().empty() ||
                      !load.inclusion_moments().empty();
  if (section.find("f") || !loaded) {
    auto file = read_force(section, *load.mutable_force());
    spots[field + ".force"] = section.spot_of("f");
    if (file) {
      file->load_case = static_cast<int>(index);
      result.force_files.push_back(*std::move(file));
    }
  }
  if (subjects.geometry) check_names(section, load, subjects);
  refuse_force_on_held(section, subjects);
}

}  // namespace

void read_loads(const Section& root, Case& result) {
  root.need("load", "write [[load]] with name and f for each load case");
  const std::vector<Section> loads =
      root.sections("load", {"name", "f", "boundary_value", "traction", "point_forces",
                             "inclusion_forces", "inclusion_moments"});
  const Subjects subjects(result.mesh);
  for (std::size_t i = 0; i < loads.size(); ++i) read_load(loads[i], i, subjects, result);
}

}  // namespace anticrack::casefile
