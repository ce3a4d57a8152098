// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {

GivenTension tension_of(const toml::node& node, const std::string& path, const Keys& law) {
  v1::Tension given;
  Spots unused;
  if (const toml::table* table = node.as_table())
    fill(Section(*table, path, law), given, "", unused);
  else if (const auto expression = node.value_exact<std::string>())
    given.set_along(*expression);
  else
    return positive_of(node, path);
  return given;
}

void read_tensions(const Section& section, v1::MeshOptions& options, Spots& spots) {
  for (const auto& [name, entry] :
       section.entries("tension", "write subdomain = tension for each")) {
    const std::string path = section.path_of("tension", name);
    const GivenTension given = tension_of(*entry, path, section.below("tension"));
    if (const auto* number = std::get_if<double>(&given))
      (*options.mutable_tension())[name] = *number;
    else
      (*options.mutable_tension_laws())[name] = std::get<v1::Tension>(given);
    for (const char* field : {"options.tension", "options.tension_laws"})
      set_entry(spots, field, name, spot_of(*entry, path));
  }
}

}  // namespace anticrack::casefile
