// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

void set_point(const Section& section, const char* key, const char* cure, v1::Point& point) {
  set(point, point_of(section.need(key, cure), section.path_of(key)));
}

// [from, to] of an interface or of the boundary.
template <class Part>
void read_pair(const toml::node& node, const std::string& key, Part& part) {
  const toml::array* pair = node.as_array();
  if (!pair || pair->size() != 2) {
    throw Error(spot_of(node, key),
                shown(node) + " is not a part; write [from, to] with points from and to");
  }
  set(*part.mutable_from(), point_of(*pair->get(0), entry_key(key, 0)));
  set(*part.mutable_to(), point_of(*pair->get(1), entry_key(key, 1)));
}

template <class Parts>
void add_pairs(const toml::array& list, const std::string& key, const std::string& field,
               Parts& parts, Spots& spots) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    read_pair(*list.get(i), entry_key(key, i), *parts.Add());
    spots[entry_field(field, i)] = spot_of(*list.get(i), entry_key(key, i));
  }
}

// Name and ends of an inclusion or a crack.
template <class Line>
void read_line(const Section& section, const std::string& field, Line& line, Spots& spots) {
  constexpr const char* cure = "write [x, y], a point of an interface";
  set_point(section, "from", cure, *line.mutable_part()->mutable_from());
  set_point(section, "to", cure, *line.mutable_part()->mutable_to());
  note(section, field, spots);
  note(section, field + ".part", spots);
  spots[field + ".part"] = section.spot_of("from");
}

void read_delamination(const Section& section, const std::string& field, v1::Inclusion& inclusion,
                       Spots& spots) {
  const toml::node* node = section.find("delaminated");
  if (!node) return;
  const std::string key = section.path_of("delaminated");
  const std::string parts = field + ".delaminated_parts";
  spots[parts] = section.spot_of("delaminated");
  if (const toml::array* list = node->as_array()) {
    add_pairs(*list, key, parts + ".parts", *inclusion.mutable_delaminated_parts()->mutable_parts(),
              spots);
  } else if (const auto all = node->value_exact<bool>()) {
    inclusion.set_delaminated(*all);
  } else {
    throw Error(spot_of(*node, key),
                shown(*node) + " is not possible; write true, false or [[from, to], ...]");
  }
}

void read_inclusions(const Section& geometry_section, v1::Geometry& geometry, Spots& spots) {
  for (const Section& section : geometry_section.sections(
           "inclusion", {"name", "from", "to", "delaminated", "tilt", "fixed", "contact"})) {
    refuse_keys(section, {"contact"},
                "belongs to [[geometry.crack]]; an inclusion has delaminated = true or false");
    const std::string field = entry_field("geometry.inclusions", geometry.inclusions().size());
    v1::Inclusion& inclusion = *geometry.add_inclusions();
    inclusion.set_name(section.need_text("name", "give the inclusion a name"));
    read_line(section, field, inclusion, spots);
    read_delamination(section, field, inclusion, spots);
    read_motion(section, inclusion);
  }
}

void read_cracks(const Section& geometry_section, v1::Geometry& geometry, Spots& spots) {
  for (const Section& section :
       geometry_section.sections("crack", {"name", "from", "to", "contact", "tilt", "fixed"})) {
    refuse_keys(section, {"tilt", "fixed"},
                "belongs to [[geometry.inclusion]]; nothing rigid lies on a crack, so remove it");
    const std::string field = entry_field("geometry.cracks", geometry.cracks().size());
    v1::Crack& crack = *geometry.add_cracks();
    crack.set_name(section.need_text("name", "give the crack a name"));
    read_line(section, field, crack, spots);
    if (const auto contact = section.boolean("contact")) crack.set_contact(*contact);
  }
}

void read_neumann(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const toml::node* node = section.find("neumann");
  if (!node) return;
  if (const toml::array* list = node->as_array()) {
    add_pairs(*list, section.path_of("neumann"), "geometry.neumann", *geometry.mutable_neumann(),
              spots);
    return;
  }
  if (node->value_exact<std::string>() != "all") {
    throw Error(section.spot_of("neumann"),
                shown(*node) +
                    " is not possible; write [[from, to], ...], parts of the boundary "
                    "walked counterclockwise, or \"all\"");
  }
  if (geometry.boundary().empty()) return;
  // A part from a point to itself is the whole boundary.
  v1::BoundaryPart& part = *geometry.add_neumann();
  *part.mutable_from() = geometry.boundary(0);
  *part.mutable_to() = geometry.boundary(0);
}

void read_regions(const Section& geometry_section, v1::Geometry& geometry, Spots& spots) {
  for (const Section& section : geometry_section.sections("region", {"name", "at", "tension"})) {
    note(section, entry_field("geometry.regions", geometry.regions().size()), spots);
    v1::Region& region = *geometry.add_regions();
    region.set_name(section.need_text("name", "give the region a name"));
    set_point(section, "at", "write [x, y], a point inside the region", *region.mutable_at());
    if (const auto tension = section.positive("tension")) region.set_tension(*tension);
  }
}

}  // namespace

v1::Geometry read_geometry(const Section& section, Spots& spots) {
  v1::Geometry geometry;
  note(section, "geometry", spots);
  add_points(section.need("boundary", "write [[x, y], [x, y], ...]"), section.path_of("boundary"),
             "geometry.boundary", *geometry.mutable_boundary(), spots);
  read_interfaces(section, geometry, spots);
  read_inclusions(section, geometry, spots);
  read_cracks(section, geometry, spots);
  read_neumann(section, geometry, spots);
  read_regions(section, geometry, spots);
  return geometry;
}

}  // namespace anticrack::casefile
