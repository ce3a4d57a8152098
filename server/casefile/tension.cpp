// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {

std::optional<GivenTension> tension_of(const Section& section, const std::string& key) {
  const toml::node* node = section.find(key);
  if (!node) return std::nullopt;
  v1::Tension law;
  if (node->is_table()) {
    const Section table = *section.section(key, {"along", "across", "angle"});
    table.need("along", "write the tension in the direction of angle, a number or an expression");
    law.set_along(*table.expression("along"));
    law.set_across(table.expression("across").value_or(""));
    law.set_angle(table.number("angle").value_or(0));
  } else if (node->is_string()) {
    law.set_along(*section.text(key));
  } else {
    return *section.positive(key);
  }
  return law;
}

void read_tensions(const Section& section, v1::MeshOptions& options, Spots& spots) {
  std::vector<std::string> names;
  for (const auto& [name, entry] : section.entries("tension", "write subdomain = tension for each"))
    names.push_back(name);
  if (names.empty()) return;
  const Section tensions = *section.section("tension", names);
  for (const std::string& name : names) {
    const GivenTension given = *tension_of(tensions, name);
    if (const auto* number = std::get_if<double>(&given))
      (*options.mutable_tension())[name] = *number;
    else
      (*options.mutable_tension_laws())[name] = std::get<v1::Tension>(given);
    for (const char* field : {"options.tension", "options.tension_laws"})
      set_entry(spots, field, name, tensions.spot_of(name));
  }
}

}  // namespace anticrack::casefile
