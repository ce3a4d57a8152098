// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace anticrack::casefile {
namespace {

// Reads the boundary: a polygon, or sides.
void read_boundary(const Section& geometry_section, v1::Geometry& geometry, Spots& spots) {
  const toml::node& node = geometry_section.need("boundary");
  if (!lists_tables(node)) {
    add_points(node, geometry_section.path_of("boundary"), "geometry.boundary",
               *geometry.mutable_boundary(), spots);
    return;
  }
  spots["geometry.sides"] = geometry_section.spot_of("boundary");
  read_list(geometry_section, "boundary", "geometry.sides", *geometry.mutable_sides(), spots,
            [&](const Section& section, const std::string& field, v1::Side& side) {
              const std::string shape = shape_of(section, "the side");
              if (shape.empty()) {
                throw Error(
                    section.spot(),
                    "a side without a shape; write points = [[x, y], ...], arc = [from, through, "
                    "to] or spline = [[x, y], ...]");
              }
              read_line(section, shape, field + ".line", *side.mutable_line(), spots);
            });
}

void read_region(const Section& section, const std::string& field, v1::Region& region,
                 Spots& spots) {
  const std::string shape = shape_of(section, "the region");
  if (shape.empty()) {
    section.need(
        "at", "write [x, y], a point inside the region, or its outline: circle, points or spline");
  }
  if (shape != "at")
    read_outline(section, "the region", field + ".outline", *region.mutable_outline(), spots);
  const toml::node* node = section.find("tension");
  if (!node) return;
  const GivenTension given =
      tension_of(*node, section.path_of("tension"), section.below("tension"));
  if (const auto* number = std::get_if<double>(&given)) {
    region.set_tension(*number);
  } else {
    *region.mutable_tension_law() = std::get<v1::Tension>(given);
    spots[field + ".tension_law"] = section.spot_of("tension");
  }
}

}  // namespace

void read_neumann(const Section& section, v1::Geometry& geometry, Spots& spots) {
  constexpr const char* cure =
      " is not possible; write a list of names of sides and holes, or of [from, to], parts of the "
      "boundary walked counterclockwise, or \"all\"";
  const toml::node* node = section.find("neumann");
  if (!node) return;
  spots["geometry.neumann_sides"] = section.spot_of("neumann");
  const toml::array* list = node->as_array();
  for (std::size_t i = 0; list && i < list->size(); ++i) {
    const toml::node& entry = *list->get(i);
    const std::string key = entry_key(section.path_of("neumann"), i);
    if (const auto name = entry.value_exact<std::string>()) {
      spots[entry_field("geometry.neumann_sides", geometry.neumann_sides_size())] =
          spot_of(entry, key);
      geometry.add_neumann_sides(*name);
    } else {
      spots[entry_field("geometry.neumann", geometry.neumann_size())] = spot_of(entry, key);
      read_pair(entry, key, *geometry.add_neumann());
    }
  }
  if (list) return;
  if (node->value_exact<std::string>() != "all")
    throw Error(section.spot_of("neumann"), shown(*node) + cure);
  const auto add_names = [&](const auto& owners, const std::string& other) {
    for (int i = 0; i < owners.size(); ++i) {
      geometry.add_neumann_sides(owners[i].name().empty() ? fmt::format("{}{}", other, i + 1)
                                                          : owners[i].name());
    }
  };
  add_names(geometry.sides(), "side-");
  add_names(geometry.holes(), "hole-");
  if (geometry.boundary().empty()) return;
  // A part from a point to itself is the whole polygon.
  v1::BoundaryPart& part = *geometry.add_neumann();
  *part.mutable_from() = geometry.boundary(0);
  *part.mutable_to() = geometry.boundary(0);
}

void note_missing_tension(Case& result) {
  const auto& regions = result.mesh.geometry().regions();
  const auto given = [](const v1::Region& region) {
    return region.has_tension() || region.has_tension_law();
  };
  const auto with = std::ranges::count_if(regions, given);
  const v1::Units& names = result.spec.units();
  const v1::MeshOptions& options = result.mesh.options();
  if (with == 0 && options.tension().empty() && options.tension_laws().empty() &&
      !names.length().empty() && !names.force().empty()) {
    result.notes.push_back(
        prefix(result.spots.at("units")) + "nothing gives a tension, so T is 1 " + names.force() +
        "/" + names.length() + "; write " +
        (result.mesh_file ? "[mesh.tension]" : "tension in [[geometry.region]]"));
  }
  const auto first = std::ranges::find_if_not(regions, given);
  if (with == 0 || first == regions.end()) return;
  const auto others = regions.size() - with - 1;
  const Spot& spot = result.spots.at(entry_field("geometry.regions", first - regions.begin()));
  result.notes.push_back(
      prefix(spot) + (others == 0 ? "it gives" : fmt::format("it and {} more give", others)) +
      " no tension, though other regions do, so " + (others == 0 ? "its" : "their") +
      " tension is 1; write tension = 1 where that is meant");
}

v1::Geometry read_geometry(const Section& section, Spots& spots) {
  v1::Geometry geometry;
  fill(section, geometry, "geometry", spots);
  read_boundary(section, geometry, spots);
  read_list(section, "hole", "geometry.holes", *geometry.mutable_holes(), spots,
            [&](const Section& one, const std::string& field, v1::Hole& hole) {
              read_outline(one, "the hole", field + ".outline", *hole.mutable_outline(), spots);
            });
  read_interfaces(section, geometry, spots);
  read_parts(section, geometry, spots);
  read_neumann(section, geometry, spots);
  read_list(section, "region", "geometry.regions", *geometry.mutable_regions(), spots,
            [&](const Section& one, const std::string& field, v1::Region& region) {
              read_region(one, field, region, spots);
            });
  return geometry;
}

}  // namespace anticrack::casefile
