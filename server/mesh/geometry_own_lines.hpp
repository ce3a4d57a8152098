// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inclusions, cracks and regions that are given by lines of their own, as interfaces.
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_field.hpp"

namespace anticrack::mesh {

/// A geometry in which the lines of inclusions, cracks and regions follow the given interfaces.
struct Drawn : Geometry {
  explicit Drawn(const Geometry& given) : Geometry(given) {}

  std::vector<Field> fields;         ///< of each interface: "interfaces[0].polyline"
  std::vector<int> inclusion_lines;  ///< of each inclusion its own interface; -1: it has a part
  std::vector<int> crack_lines;      ///< of each crack
  std::vector<int> region_lines;     ///< of each region; -1: it has a point inside
};

/// The parts of inclusions and cracks with a line get its ends. Throws errors::Error
/// (geometry_invalid) at "inclusions[1].line.segment.length", "regions[0].outline.circle.radius",
/// "inclusions[0].part" (where neither is given), ... O(size).
Drawn draw(const Geometry& given);

/// A line or outline as an interface without a name; `field`: of the line, to which its shape is
/// added. Throws as draw().
InterfaceSpec curve_of(const LineSpec& line, Field& field);
InterfaceSpec curve_of(const OutlineSpec& outline, Field& field);

}  // namespace anticrack::mesh
