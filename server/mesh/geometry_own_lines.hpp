// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes interfaces of the lines by which inclusions, cracks and regions are given.
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_field.hpp"

namespace anticrack::mesh {

/// A geometry in which the lines of inclusions, cracks and regions follow the given interfaces.
struct Drawn : Geometry {
  explicit Drawn(const Geometry& given) : Geometry(given) {}

  std::vector<Field> fields;         ///< per interface: like "interfaces[0].polyline"
  std::vector<int> inclusion_lines;  ///< per inclusion: its own interface; -1: it has a part
  std::vector<int> crack_lines;      ///< per crack
  std::vector<int> region_lines;     ///< per region; -1: it is given by a point inside
};

/// The parts of inclusions and cracks that have a line get its ends. Throws errors::Error
/// (geometry_invalid) at "inclusions[1].line.segment.length", "regions[0].outline.circle.radius",
/// "inclusions[0].part" (if neither part nor line is given), ... O(size).
Drawn draw(const Geometry& given);

/// A line or outline as an interface without a name. `field`: that of the line; its shape is
/// appended. Throws as draw().
InterfaceSpec curve_of(const LineSpec& line, Field& field);
InterfaceSpec curve_of(const OutlineSpec& outline, Field& field);

}  // namespace anticrack::mesh
