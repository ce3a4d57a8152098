// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

#include <optional>

namespace anticrack::casefile {
namespace {

constexpr const char* force_cure =
    "write a number, an expression in x and y in quotes, {region = number} or {file = \"f.h5\", "
    "dataset = \"/f\", per = \"triangle\"}";

// Whether a table names a file. A region may be called "file" too, but its value is a number.
bool names_a_file(const toml::table& table) {
  const toml::node* file = table.get("file");
  return table.contains("dataset") || table.contains("per") || (file && !file->is_number());
}

// Reads f; returns its file, if the values are in one.
std::optional<ForceFile> read_force(const Section& section, const std::string& field,
                                    v1::Force& force, Spots& spots) {
  const toml::node& node = section.need("f", force_cure);
  const toml::table* table = node.as_table();
  if (table && names_a_file(*table)) {
    const Section array = *section.section("f");
    fill(array, *force.mutable_array(), field + ".array", spots);
    force.mutable_array()->set_per_triangle(*array.choice("per", {"triangle", "node"}) == 0);
    return ForceFile{0, *array.text("file"), *array.text("dataset")};
  }
  if (const auto expression = node.value_exact<std::string>()) {
    force.set_expression(*expression);
  } else if (table) {
    add_numbers(section, "f", "write one number for each region", field + ".per_region",
                *force.mutable_per_region()->mutable_values(), spots);
  } else {
    force.set_constant(number_of(node, section.path_of("f"), force_cure));
  }
  return std::nullopt;
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

void read_load(const Section& section, const std::string& field, v1::LoadCase& load, Case& result) {
  add_numbers(section, "inclusion_forces", "write inclusion = number for each of them",
              field + ".inclusion_forces", *load.mutable_inclusion_forces(), result.spots);
  read_moments(section, field, load, result.spots);

  // Without any other load, a missing f is most likely forgotten.
  const bool loaded = !load.boundary_value().empty() || !load.traction().empty() ||
                      !load.point_forces().empty() || !load.inclusion_forces().empty() ||
                      !load.inclusion_moments().empty();
  if (section.find("f") || !loaded) {
    auto file = read_force(section, field + ".force", *load.mutable_force(), result.spots);
    if (file) {
      file->load_case = result.spec.load_cases_size() - 1;
      result.force_files.push_back(*std::move(file));
    }
  }
}

}  // namespace

void read_loads(const Section& root, Case& result) {
  root.need("load", "write [[load]] with name and f for each load case");
  read_list(root, "load", "load_cases", *result.spec.mutable_load_cases(), result.spots,
            [&](const Section& section, const std::string& field, v1::LoadCase& load) {
              read_load(section, field, load, result);
            });
}

}  // namespace anticrack::casefile
