// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/geometry.hpp"

#include <utility>

namespace anticrack::casefile {
namespace {

constexpr const char* write_points = "write [[x, y], [x, y], ...]";
constexpr const char* write_point = "write [x, y], a point of the interface";

void set(v1::Point& point, const Point& xy) {
  point.set_x(xy[0]);
  point.set_y(xy[1]);
}

std::vector<Point> need_points(const Section& section, std::string_view key) {
  return points_of(section.need(key, write_points), section.path_of(key));
}

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

void read_delaminated_parts(const toml::array& list, const std::string& key,
                            const std::string& field, v1::InterfaceParts& parts, Spots& spots) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const toml::node& entry = *list.get(i);
    const std::string entry_key = key + "." + std::to_string(i);
    const toml::array* pair = entry.as_array();
    if (!pair || pair->size() != 2) {
      throw Error(spot_of(entry, entry_key),
                  shown(entry) + " is no part; write [from, to] with points from and to");
    }
    v1::InterfacePart& part = *parts.add_parts();
    set(*part.mutable_from(), point_of(*pair->get(0), entry_key + ".0"));
    set(*part.mutable_to(), point_of(*pair->get(1), entry_key + ".1"));
    spots[field + ".parts[" + std::to_string(i) + "]"] = spot_of(entry, entry_key);
  }
}

void read_delamination(const Section& section, const std::string& field, v1::Inclusion& inclusion,
                       Spots& spots) {
  const toml::node* node = section.find("delaminated");
  if (!node) {
    return;
  }
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

std::string entry_of(const char* list, std::size_t index) {
  return std::string("geometry.") + list + "[" + std::to_string(index) + "]";
}

}  // namespace

v1::Geometry read_geometry(const Section& section, Spots& spots) {
  v1::Geometry geometry;
  spots["geometry"] = section.spot();
  for (const Point& xy : need_points(section, "boundary")) {
    set(*geometry.add_boundary(), xy);
  }
  spots["geometry.boundary"] = section.spot_of("boundary");
  for (const Point& xy : need_points(section, "interface")) {
    set(*geometry.mutable_interface()->add_points(), xy);
  }
  spots["geometry.interface"] = section.spot_of("interface");

  const std::vector<Section> inclusions =
      section.sections("inclusion", {"name", "from", "to", "delaminated"});
  for (std::size_t i = 0; i < inclusions.size(); ++i) {
    const std::string field = entry_of("inclusions", i);
    v1::Inclusion& inclusion = *geometry.add_inclusions();
    inclusion.set_name(inclusions[i].need_text("name", "give the inclusion a name"));
    read_part(inclusions[i], field, *inclusion.mutable_part(), spots);
    read_delamination(inclusions[i], field, inclusion, spots);
  }
  const std::vector<Section> cracks = section.sections("crack", {"name", "from", "to"});
  for (std::size_t i = 0; i < cracks.size(); ++i) {
    v1::Crack& crack = *geometry.add_cracks();
    crack.set_name(cracks[i].need_text("name", "give the crack a name"));
    read_part(cracks[i], entry_of("cracks", i), *crack.mutable_part(), spots);
  }
  return geometry;
}

}  // namespace anticrack::casefile
