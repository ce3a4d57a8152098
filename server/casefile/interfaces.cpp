// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

void read_interface(const Section& section, const std::string& field, v1::InterfaceCurve& curve,
                    Spots& spots) {
  note(section, field, spots);
  curve.set_name(section.text("name").value_or(""));
  const std::string shape = shape_of(section, {"points", "arc", "spline"}, "the interface");
  if (shape.empty()) {
    throw Error(section.spot(),
                "an interface without a shape; write points = [[x, y], ...], arc = [from, "
                "through, to] or spline = [[x, y], ...]");
  }
  read_curve(section, shape, field, curve, spots);
  if (shape == "arc" && section.find("closed")) {
    throw Error(section.spot_of("closed"),
                "an arc has two ends; remove the key, or write a spline through the points");
  }
  curve.set_closed(section.boolean("closed").value_or(false));
}

}  // namespace

void read_interfaces(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const toml::node* node = section.find("interface");
  if (!node) return;
  spots["geometry.interfaces"] = section.spot_of("interface");
  if (!lists_tables(*node)) {
    const std::string field = entry_field("geometry.interfaces", 0);
    v1::Polyline& line = *geometry.add_interfaces()->mutable_polyline();
    spots[field] = spots[field + ".polyline"] = section.spot_of("interface");
    add_points(*node, section.path_of("interface"), field + ".polyline.points",
               *line.mutable_points(), spots);
    return;
  }
  for (const Section& interface :
       section.sections("interface", {"name", "points", "arc", "spline", "closed"})) {
    const std::string field = entry_field("geometry.interfaces", geometry.interfaces().size());
    read_interface(interface, field, *geometry.add_interfaces(), spots);
  }
}

}  // namespace anticrack::casefile
