// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

constexpr const char* shapes =
    "points = [[x, y], ...], arc = [from, through, to] or spline = "
    "[[x, y], ...]";

void read_arc(const Section& section, v1::Arc& arc) {
  const toml::node& node = section.need("arc", shapes);
  const std::vector<Point> points = points_of(node, section.path_of("arc"));
  if (points.size() != 3) {
    throw Error(section.spot_of("arc"),
                shown(node) +
                    " is not an arc; write [from, through, to], three points "
                    "with the second between the others");
  }
  set(*arc.mutable_from(), points[0]);
  set(*arc.mutable_through(), points[1]);
  set(*arc.mutable_to(), points[2]);
}

void read_line(const Section& section, const char* key, const std::string& field,
               v1::Polyline& line, Spots& spots) {
  add_points(section.need(key, shapes), section.path_of(key), field + ".points",
             *line.mutable_points(), spots);
  spots[field] = section.spot_of(key);
}

// The one shape of an interface; the error names the second, or says that there is none.
std::string shape_of(const Section& section) {
  std::string shape;
  for (const char* key : {"points", "arc", "spline"}) {
    if (!section.find(key)) continue;
    if (!shape.empty()) {
      throw Error(section.spot_of(key),
                  "the interface has " + shape + " too; remove one of the two");
    }
    shape = key;
  }
  if (shape.empty())
    throw Error(section.spot(), std::string("an interface without a shape; write ") + shapes);
  return shape;
}

void read_interface(const Section& section, const std::string& field, v1::InterfaceCurve& curve,
                    Spots& spots) {
  note(section, field, spots);
  curve.set_name(section.text("name").value_or(""));
  const std::string shape = shape_of(section);
  if (shape == "arc") {
    read_arc(section, *curve.mutable_arc());
    if (section.find("closed")) {
      throw Error(section.spot_of("closed"),
                  "an arc has two ends; remove the key, or write a spline through the points");
    }
  } else if (shape == "points") {
    read_line(section, "points", field + ".polyline", *curve.mutable_polyline(), spots);
  } else {
    read_line(section, "spline", field + ".spline", *curve.mutable_spline(), spots);
  }
  curve.set_closed(section.boolean("closed").value_or(false));
}

bool lists_tables(const toml::node& node) {
  const toml::array* list = node.as_array();
  return node.is_table() || (list && !list->empty() && list->get(0)->is_table());
}

}  // namespace

void read_interfaces(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const toml::node* node = section.find("interface");
  if (!node) return;
  spots["geometry.interfaces"] = section.spot_of("interface");
  if (!lists_tables(*node)) {
    const std::string field = entry_field("geometry.interfaces", 0);
    spots[field] = section.spot_of("interface");
    read_line(section, "interface", field + ".polyline",
              *geometry.add_interfaces()->mutable_polyline(), spots);
    return;
  }
  for (const Section& interface :
       section.sections("interface", {"name", "points", "arc", "spline", "closed"})) {
    const std::string field = entry_field("geometry.interfaces", geometry.interfaces().size());
    read_interface(interface, field, *geometry.add_interfaces(), spots);
  }
}

}  // namespace anticrack::casefile
