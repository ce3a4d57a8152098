// SPDX-License-Identifier: GPL-3.0-or-later
#include "casefile/sections.hpp"

namespace anticrack::casefile {
namespace {

void add_list(const Section& section, const std::string& key, const std::string& field,
              v1::Polyline& line, Spots& spots) {
  add_points(*section.find(key), section.path_of(key), field + ".points", *line.mutable_points(),
             spots);
  spots[field] = section.spot_of(key);
}

void read_arc(const Section& section, v1::Arc& arc) {
  const toml::node& node = *section.find("arc");
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

template <class Curve>
void read_any(const Section& section, const std::string& key, const std::string& field,
              Curve& curve, Spots& spots) {
  if (key == "arc")
    read_arc(section, *curve.mutable_arc());
  else if (key == "points")
    add_list(section, key, field + ".polyline", *curve.mutable_polyline(), spots);
  else
    add_list(section, key, field + ".spline", *curve.mutable_spline(), spots);
}

}  // namespace

std::string shape_of(const Section& section, const std::string& what) {
  std::string shape;
  for (const char* key : {"at", "circle", "points", "arc", "spline", "center"}) {
    if (!section.find(key)) continue;
    if (!shape.empty())
      throw Error(section.spot_of(key), what + " has " + shape + " too; remove one of the two");
    shape = key;
  }
  return shape;
}

void read_curve(const Section& section, const std::string& key, const std::string& field,
                v1::InterfaceCurve& curve, Spots& spots) {
  read_any(section, key, field, curve, spots);
}

void read_line(const Section& section, const std::string& key, const std::string& field,
               v1::Line& line, Spots& spots) {
  spots[field] = section.spot_of(key);
  if (key != "center") return read_any(section, key, field, line, spots);
  section.need("length", "write its length, beside its center");
}

void read_outline(const Section& section, const std::string& what, const std::string& field,
                  v1::Outline& outline, Spots& spots) {
  const std::string shape = shape_of(section, what);
  if (shape.empty()) {
    throw Error(section.spot(),
                what +
                    " without a shape; write circle = { center = [x, y], radius = r }, points = "
                    "[[x, y], ...] or spline = [[x, y], ...]");
  }
  spots[field] = section.spot_of(shape);
  if (shape == "points")
    add_list(section, shape, field + ".polygon", *outline.mutable_polygon(), spots);
  if (shape == "spline")
    add_list(section, shape, field + ".spline", *outline.mutable_spline(), spots);
}

bool lists_tables(const toml::node& node) {
  const toml::array* array = node.as_array();
  return node.is_table() || (array && !array->empty() && array->get(0)->is_table());
}

}  // namespace anticrack::casefile
