// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

#include <algorithm>
#include <optional>

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

ForceFile read_force_file(const Section& section, const std::filesystem::path& folder) {
  ForceFile file;
  file.path = folder / section.need_text("file", "name an HDF5 file");
  file.dataset = section.need_text("dataset", "name the dataset in the file, as \"/f\"");
  section.need("per", "write per = \"triangle\" or per = \"node\"");
  file.per_triangle = *section.choice("per", {"triangle", "node"}) == 0;
  return file;
}

// Empty where the values are not in a file.
std::optional<ForceFile> read_force(const Section& section, const std::filesystem::path& folder,
                                    v1::Force& force) {
  const toml::node& node = section.need("f", force_cure);
  const toml::table* table = node.as_table();
  if (table && names_a_file(*table)) {
    ForceFile file = read_force_file(*section.section("f", {"file", "dataset", "per"}), folder);
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

// What a load names must be in the geometry; what is in a .msh file the server says.
void check_names(const Section& section, const char* key, const std::string& what,
                 const std::vector<std::string>& known) {
  for (const auto& [name, entry] : section.entries(key, "")) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::vector<std::string> sorted = known;
    std::ranges::sort(sorted);
    const auto twice = std::ranges::adjacent_find(sorted);
    throw Error(spot_of(*entry, section.path_of(key, name)),
                "there is no " + what + " of this name; " +
                    (known.empty() ? "name one by [[geometry." + what + "]]"
                     : twice != sorted.end()
                         ? "two " + what + "s are called \"" + *twice + "\": give each its own name"
                         : words::suggestion(name, known)));
  }
}

void check_names(const Section& section, const v1::LoadCase& load, const v1::Geometry& geometry) {
  std::vector<std::string> regions, inclusions;
  for (const v1::Region& region : geometry.regions()) regions.push_back(region.name());
  for (const v1::Inclusion& inclusion : geometry.inclusions())
    inclusions.push_back(inclusion.name());
  // Where a subdomain has no region it is omega1, omega2, ...: only the server knows how many.
  for (const auto& [region, value] : load.force().per_region().values())
    if (region.starts_with("omega")) regions.push_back(region);
  if (!load.traction().empty() && load.traction() != "0" && geometry.neumann().empty() &&
      geometry.neumann_sides().empty()) {
    throw Error(section.spot_of("traction"),
                "nothing has a traction, as no part of the boundary is in geometry.neumann; name "
                "its sides or holes there");
  }
  if (load.force().has_per_region()) check_names(section, "f", "region", regions);
  check_names(section, "inclusion_forces", "inclusion", inclusions);
  check_names(section, "inclusion_moments", "inclusion", inclusions);
  for (const v1::Inclusion& inclusion : geometry.inclusions()) {
    if (inclusion.tilt() || !load.inclusion_moments().contains(inclusion.name())) continue;
    throw Error(section.spot_of("inclusion_moments"),
                "the inclusion \"" + inclusion.name() +
                    "\" does not tilt, so a moment on it does nothing; write tilt = true in its "
                    "[[geometry.inclusion]], or leave the moment out");
  }
}

// The server takes it, as its work belongs to the energy, but nothing moves by it.
void refuse_force_on_held(const std::string& name, const v1::LoadCase& load,
                          const std::string& field, const Spots& spots) {
  if (!load.inclusion_forces().contains(name)) return;
  throw Error(
      spots.at(field + ".inclusion_forces." + name),
      "the inclusion is held by its key fixed, so a force on it moves nothing; leave one of "
      "the two out");
}

void read_load(const Section& section, std::size_t index, Case& result) {
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
    auto file = read_force(section, result.path.parent_path(), *load.mutable_force());
    spots[field + ".force"] = section.spot_of("f");
    if (file) {
      file->load_case = static_cast<int>(index);
      result.force_files.push_back(*std::move(file));
    }
  }
  if (result.mesh.has_geometry()) check_names(section, load, result.mesh.geometry());
  for (const v1::Inclusion& inclusion : result.mesh.geometry().inclusions())
    if (inclusion.has_fixed()) refuse_force_on_held(inclusion.name(), load, field, spots);
  for (const auto& [name, motion] : result.mesh.options().inclusion_motions())
    if (motion.has_fixed()) refuse_force_on_held(name, load, field, spots);
}

}  // namespace

void read_loads(const Section& root, Case& result) {
  root.need("load", "write [[load]] with name and f for each load case");
  const std::vector<Section> loads =
      root.sections("load", {"name", "f", "boundary_value", "traction", "point_forces",
                             "inclusion_forces", "inclusion_moments"});
  for (std::size_t i = 0; i < loads.size(); ++i) read_load(loads[i], i, result);
}

}  // namespace anticrack::casefile
