// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/case.hpp"

#include <fstream>
#include <sstream>
#include <utility>

#include "casefile/geometry.hpp"
#include "casefile/nearest.hpp"
#include "casefile/overrides.hpp"
#include "casefile/section.hpp"

namespace anticrack::casefile {
namespace {

void read_mesh(const Section& root, Case& result) {
  const auto geometry = root.section("geometry", geometry_keys);
  const auto mesh = root.section("mesh", {"preset", "size", "file"});
  const auto file = mesh ? mesh->text("file") : std::nullopt;
  if (file) {
    for (const char* key : {"preset", "size"}) {
      if (mesh->find(key)) {
        throw Error(mesh->spot_of(key), "means nothing with mesh.file; remove one of the two");
      }
    }
    if (geometry) {
      throw Error(geometry->spot(), "there is a mesh.file too; remove one of the two");
    }
    result.mesh_file = result.path.parent_path() / *file;
    for (const char* field : {"upload", "header", "chunk"}) {
      result.spots[field] = mesh->spot_of("file");
    }
    return;
  }
  root.need("geometry", "write [geometry] with boundary and interface, or mesh.file = \"x.msh\"");
  *result.mesh.mutable_geometry() = read_geometry(*geometry, result.spots);
  v1::MeshOptions& options = *result.mesh.mutable_options();
  options.set_preset(v1::MESH_PRESET_PAPER);
  if (!mesh) {
    return;
  }
  result.spots["options"] = mesh->spot();
  if (const auto preset = mesh->choice("preset", {"paper", "uniform", "graded"})) {
    options.set_preset(
        static_cast<v1::MeshPreset>(v1::MESH_PRESET_PAPER + static_cast<int>(*preset)));
    result.spots["options.preset"] = mesh->spot_of("preset");
  }
  if (const auto size = mesh->number("size")) {
    if (options.preset() != v1::MESH_PRESET_UNIFORM) {
      throw Error(mesh->spot_of("size"),
                  "means nothing with this preset; write preset = \"uniform\" beside it");
    }
    options.set_size(*size);
    result.spots["options.size"] = mesh->spot_of("size");
  }
}

void read_step(const Section& section, v1::Uzawa& uzawa) {
  const toml::node* node = section.find("theta");
  if (!node) {
    return;
  }
  if (node->value_exact<std::string>() == "auto") {
    uzawa.set_theta_auto(true);
  } else {
    uzawa.set_theta(
        number_of(*node, section.path_of("theta"), "write a number above 0, or \"auto\""));
  }
}

void read_uzawa(const Section& section, v1::Uzawa& uzawa, Spots& spots) {
  read_step(section, uzawa);
  if (const auto epsilon = section.number("epsilon")) {
    uzawa.set_epsilon(*epsilon);
  }
  if (const auto p = section.number("p")) {
    uzawa.set_p(*p);
  }
  if (const auto limit = section.count("max_iterations")) {
    uzawa.set_max_iterations(*limit);
  }
  if (const auto mass = section.choice("mass", {"lumped", "consistent"})) {
    uzawa.set_mass(*mass == 0 ? v1::MASS_LUMPED : v1::MASS_CONSISTENT);
  }
  for (const char* key : {"theta", "epsilon", "p", "max_iterations", "mass"}) {
    if (section.find(key)) {
      spots[std::string("solver.uzawa.") + key] = section.spot_of(key);
    }
  }
  if (uzawa.theta_auto()) {
    spots["solver.uzawa.theta_auto"] = section.spot_of("theta");
  }
}

void read_solver(const Section& root, Case& result) {
  v1::Solver& solver = *result.job.mutable_solver();
  const auto section =
      root.section("solver", {"method", "theta", "epsilon", "p", "max_iterations", "mass"});
  if (!section) {
    solver.mutable_uzawa();
    return;
  }
  result.spots["solver"] = section->spot();
  const auto method = section->choice("method", {"uzawa", "active-set"});
  if (method) {
    result.spots["solver.method"] = section->spot_of("method");
  }
  if (method.value_or(0) == 0) {
    read_uzawa(*section, *solver.mutable_uzawa(), result.spots);
    return;
  }
  solver.mutable_active_set();
  result.spots["solver.active_set"] = section->spot_of("method");
  for (const char* key : {"theta", "epsilon", "p", "max_iterations", "mass"}) {
    if (section->find(key)) {
      throw Error(section->spot_of(key),
                  "belongs to method \"uzawa\"; remove it, or write method = \"uzawa\"");
    }
  }
}

void read_regions(const toml::table& table, const std::string& key, v1::Force& force) {
  auto& values = *force.mutable_per_region()->mutable_values();
  for (const auto& [region, node] : table) {
    const std::string name(region.str());
    values[name] = number_of(node, key + "." + name, "write one number for each region");
  }
}

void read_force(const Section& section, v1::Force& force) {
  const toml::node& node =
      section.need("f", "write a number, an expression in x and y in quotes, or {region = number}");
  const std::string key = section.path_of("f");
  if (const auto expression = node.value_exact<std::string>()) {
    force.set_expression(*expression);
  } else if (const toml::table* table = node.as_table()) {
    read_regions(*table, key, force);
  } else {
    force.set_constant(number_of(
        node, key, "write a number, an expression in x and y in quotes, or {region = number}"));
  }
}

void read_loads(const Section& root, Case& result) {
  root.need("load", "write [[load]] with name and f for each load case");
  const std::vector<Section> loads = root.sections("load", {"name", "f", "boundary_value"});
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const Section& section = loads[i];
    const std::string field = "load_cases[" + std::to_string(i) + "]";
    v1::LoadCase& load = *result.job.add_load_cases();
    load.set_name(section.need_text("name", "give the load case a name"));
    result.spots[field] = section.spot();
    result.spots[field + ".name"] = section.spot_of("name");
    if (const auto value = section.text("boundary_value")) {
      load.set_boundary_value(*value);
      result.spots[field + ".boundary_value"] = section.spot_of("boundary_value");
    }
    if (section.find("f") || load.boundary_value().empty()) {
      read_force(section, *load.mutable_force());
      result.spots[field + ".force"] = section.spot_of("f");
    }
  }
}

toml::table parse(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw Error({"", name, error.source().begin.line},
                "this is not TOML: " + std::string(error.description()));
  }
}

}  // namespace

std::optional<Spot> Case::locate(const std::string& field) const {
  std::string place = field.rfind("job.", 0) == 0 ? field.substr(4) : field;
  while (!place.empty()) {
    const auto found = spots.find(place);
    if (found != spots.end()) {
      return found->second;
    }
    const std::size_t cut = place.find_last_of(".[");
    place.resize(cut == std::string::npos ? 0 : cut);
  }
  return std::nullopt;
}

Case parse_case(const std::string& text, const std::filesystem::path& path,
                const std::vector<std::string>& overrides) {
  Case result;
  result.path = path;
  result.text = text;
  toml::table table = parse(text, path.string());
  for (const std::string& assignment : overrides) {
    apply_override(table, assignment);
  }
  if (!overrides.empty()) {
    std::ostringstream out;
    out << table << '\n';
    result.text = out.str();
  }
  const Section root(table, "", {"title", "geometry", "mesh", "solver", "load", "output"});
  if (const auto title = root.text("title")) {
    result.mesh.set_title(*title);
    result.job.set_title(*title);
    result.spots["title"] = root.spot_of("title");
  }
  read_mesh(root, result);
  read_solver(root, result);
  read_loads(root, result);
  if (const auto output = root.section("output", {"fields"})) {
    result.job.set_fields(output->boolean("fields").value_or(false));
    result.spots["fields"] = output->spot_of("fields");
  }
  return result;
}

Case read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (std::filesystem::is_directory(path) || !file || !(text << file.rdbuf())) {
    // An empty file fails to insert as well; it is caught below by what it lacks.
    if (!std::filesystem::is_regular_file(path) || !file) {
      throw Error({"", path.string(), 0}, "cannot be read; name a case, a TOML file");
    }
  }
  return parse_case(text.str(), path, overrides);
}

}  // namespace anticrack::casefile
