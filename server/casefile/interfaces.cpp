// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {

void read_interfaces(const Section& section, v1::Geometry& geometry, Spots& spots) {
  const toml::node* node = section.find("interface");
  if (!node) return;
  auto& curves = *geometry.mutable_interfaces();
  if (!lists_tables(*node)) {
    const std::string field = entry_field("geometry.interfaces", 0);
    spots[field] = spots[field + ".polyline"] = section.spot_of("interface");
    add_points(*node, section.path_of("interface"), field + ".polyline.points",
               *curves.Add()->mutable_polyline()->mutable_points(), spots);
    return;
  }
  read_list(section, "interface", "geometry.interfaces", curves, spots,
            [&](const Section& one, const std::string& field, v1::InterfaceCurve& curve) {
              const std::string shape = shape_of(one, "the interface");
              if (shape.empty()) {
                throw Error(one.spot(),
                            "an interface without a shape; write points = [[x, y], ...], arc = "
                            "[from, through, to] or spline = [[x, y], ...]");
              }
              read_curve(one, shape, field, curve, spots);
              if (shape == "arc" && one.find("closed")) {
                throw Error(
                    one.spot_of("closed"),
                    "an arc has two ends; remove the key, or write a spline through the points");
              }
            });
}

}  // namespace anticrack::casefile
