// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/geometry.hpp"

namespace anticrack::casefile {
namespace {

constexpr const char* write_points = "write [[x, y], [x, y], ...]";
constexpr const char* write_point = "write [x, y], a point of an interface";

Point need_point(const Section& section, std::string_view key) {
  return point_of(section.need(key, write_point), section.path_of(key));
}

// `field` is the path of the inclusion or crack in the request.
void read_part(const Section& section, const std::string& field, v1::InterfacePart& part,
               Spots& spots) {
  set(*part.mutable_from(), need_point(section, "from"));
  set(*part.mutable_to(), need_point(section, "to"));
  spots[field] = section.spot();
  spots[field + ".name"] = section.spot_of("name");
  spots[field + ".part"] = section.spot_of("from");
  spots[field + ".part.from"] = section.spot_of("from");
  spots[field + ".part.to"] = section.spot_of("to");
}

// [from, to], for the parts of interfaces and of the boundary.
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

void read_delaminated_parts(const toml::array& list, const std::string& key,
                            const std::string& field, v1::InterfaceParts& parts, Spots& spots) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const toml::node& entry = *list.get(i);
    read_pair(entry, entry_key(key, i), *parts.add_parts());
    spots[entry_field(field + ".parts", i)] = spot_of(entry, entry_key(key, i));
  }
}

void read_delamination(const Section& section, const std::string& field, v1::Inclusion& inclusion,
                       Spots& spots) {
  const toml::node* node = section.find("delaminated");
  if (!node) return;
  const std::string key = section.path_of("delaminated");
  spots[field + ".delaminated"] = section.spot_of("delaminated");
  spots[field + ".delaminated_parts"] = section.spot_of("delaminated");
  if (const toml::array* list = node->as_array()) {
    read_delaminated_parts(*list, key, field + ".delaminated_parts",
                           *inclusion.mutable_delaminated_parts(), spots);
  } else if (const auto all = node->value_exact<bool>()) {
    inclusion.set_delaminated(*all);
  } else {
    throw Error(spot_of(*node, key),
                shown(*node) + " is not possible; write true, false or [[from, to], ...]");
  }
}

void read_neumann(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const toml::node* node = section.find("neumann");
  if (!node) return;
  const std::string key = section.path_of("neumann");
  spots["geometry.neumann"] = section.spot_of("neumann");
  if (node->value_exact<std::string>() == "all") {
    // From a point to itself is all of the boundary.
    if (geometry.boundary_size() > 0) {
      v1::BoundaryPart& part = *geometry.add_neumann();
      *part.mutable_from() = geometry.boundary(0);
      *part.mutable_to() = geometry.boundary(0);
    }
    return;
  }
  const toml::array* list = node->as_array();
  if (!list) {
    throw Error(spot_of(*node, key),
                shown(*node) +
                    " is not possible; write [[from, to], ...], parts of the boundary "
                    "walked counterclockwise, or \"all\"");
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    read_pair(*list->get(i), entry_key(key, i), *geometry.add_neumann());
    spots[entry_field("geometry.neumann", i)] = spot_of(*list->get(i), entry_key(key, i));
  }
}

void read_regions(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const std::vector<Section> regions = section.sections("region", {"name", "at", "tension"});
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const std::string field = entry_field("geometry.regions", i);
    v1::Region& region = *geometry.add_regions();
    spots[field] = regions[i].spot();
    region.set_name(regions[i].need_text("name", "give the region a name"));
    set(*region.mutable_at(),
        point_of(regions[i].need("at", "write [x, y], a point inside the region"),
                 regions[i].path_of("at")));
    region.set_tension(regions[i].positive("tension").value_or(0));
    for (const char* key : {"name", "at", "tension"}) {
      spots[field + "." + key] = regions[i].spot_of(key);
    }
  }
}

void read_inclusions(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const std::vector<Section> inclusions =
      section.sections("inclusion", {"name", "from", "to", "delaminated"});
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    const std::string field = entry_field("geometry.inclusions", i);
    v1::Inclusion& inclusion = *geometry.add_inclusions();
    inclusion.set_name(inclusions[i].need_text("name", "give the inclusion a name"));
    read_part(inclusions[i], field, *inclusion.mutable_part(), spots);
    read_delamination(inclusions[i], field, inclusion, spots);
  }
}

void read_cracks(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const std::vector<Section> cracks = section.sections("crack", {"name", "from", "to"});
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    v1::Crack& crack = *geometry.add_cracks();
    crack.set_name(cracks[i].need_text("name", "give the crack a name"));
    read_part(cracks[i], entry_field("geometry.cracks", i), *crack.mutable_part(), spots);
  }
}

}  // namespace

v1::Geometry read_geometry(const Section& section, Spots& spots) {
  v1::Geometry geometry;
  spots["geometry"] = section.spot();
  add_points(section.need("boundary", write_points), section.path_of("boundary"),
             "geometry.boundary", *geometry.mutable_boundary(), spots);
  spots["geometry.boundary"] = section.spot_of("boundary");
  read_interfaces(section, geometry, spots);
  read_inclusions(section, geometry, spots);
  read_cracks(section, geometry, spots);
  read_neumann(section, geometry, spots);
  read_regions(section, geometry, spots);
  return geometry;
}

}  // namespace anticrack::casefile
