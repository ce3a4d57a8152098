// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

#include <fmt/core.h>

#include <charconv>

namespace anticrack::casefile {
namespace {

constexpr const char* group_cure =
    "write the tag of a physical group and its meaning in quotes, for example curve.7 = "
    "\"crack\" or surface.1 = \"top\"";

void read_align(const Section& section, v1::MeshOptions& options, Spots& spots) {
  const toml::node* node = section.find("align");
  if (!node) return;
  const std::string key = section.path_of("align");
  const toml::array* lines = node->as_array();
  if (!lines) {
    throw Error(spot_of(*node, key),
                shown(*node) + " is not a list of lines; write [[[x, y], [x, y], ...], ...]");
  }
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const std::string field = entry_field("options.align", i);
    spots[field] = spot_of(*lines->get(i), entry_key(key, i));
    add_points(*lines->get(i), entry_key(key, i), field + ".points",
               *options.add_align()->mutable_points(), spots);
  }
}

template <class Groups>
void read_groups(const Section& section, const char* key, const std::string& field, Groups& groups,
                 Spots& spots) {
  if (section.find(key)) spots[field] = section.spot_of(key);
  for (const auto& [tag_text, entry] : section.entries(key, group_cure)) {
    const Spot spot = spot_of(*entry, section.path_of(key, tag_text));
    std::int32_t tag = 0;
    const char* end = tag_text.data() + tag_text.size();
    const auto [stopped, error] = std::from_chars(tag_text.data(), end, tag);
    if (error != std::errc() || stopped != end || tag < 1)
      throw Error(spot, fmt::format("'{}' is not a tag; {}", tag_text, group_cure));
    const auto meaning = entry->template value_exact<std::string>();
    if (!meaning || meaning->empty())
      throw Error(spot,
                  fmt::format("{} is not a meaning of a group; {}", shown(*entry), group_cure));
    groups[tag] = *meaning;
    set_entry(spots, field, tag_text, spot);
  }
}

void read_motions(const Section& section, v1::MeshOptions& options, Spots& spots) {
  constexpr const char* cure =
      "write NAME = { tilt = true } or NAME = { fixed = 0.1 } for each of them";
  const std::string field = "options.inclusion_motions";
  for (const auto& [name, entry] : section.entries("inclusions", cure)) {
    const std::string path = section.path_of("inclusions", name);
    const toml::table* motion = entry->as_table();
    if (!motion) throw Error(spot_of(*entry, path), shown(*entry) + " is not a table; " + cure);
    fill(Section(*motion, path, section.below("inclusions")),
         (*options.mutable_inclusion_motions())[name], field + "[" + name + "]", spots);
    spots[field + "." + name] = spot_of(*entry, path);
  }
}

}  // namespace

v1::MeshOptions read_mesh_options(const Section& section, Spots& spots) {
  v1::MeshOptions options;
  options.set_preset(v1::MESH_PRESET_GRADED);
  fill(section, options, "options", spots);
  read_align(section, options, spots);
  if (const auto groups = section.section("groups")) {
    read_groups(*groups, "curve", "options.curve_groups", *options.mutable_curve_groups(), spots);
    read_groups(*groups, "surface", "options.surface_groups", *options.mutable_surface_groups(),
                spots);
  }
  read_tensions(section, options, spots);
  read_motions(section, options, spots);
  return options;
}

}  // namespace anticrack::casefile
