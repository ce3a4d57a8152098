// SPDX-License-Identifier: GPL-3.0-or-later
//
// The lines that a geometry gives by their points.
#pragma once

#include <string>
#include <vector>

#include "mesh/geometry_field.hpp"
#include "mesh/geometry_line.hpp"
#include "mesh/geometry_outline.hpp"

namespace anticrack::mesh {

/// The line of a shape. `outline`: that of the membrane in which it lies. Throws errors::Error
/// (geometry_invalid, limit_exceeded) at `field` or below it: too few points, one far outside, two
/// equal ones, a polyline that meets itself, a flat arc. O(v log v + pairs of edges over the same
/// x).
Line lay_curve(const InterfaceSpec& spec, const Field& field, const Outline& outline);

/// The vertices of a line, and ends of chords of at most five degrees where it is curved.
std::vector<Point> polygon_of(const Line& line);

}  // namespace anticrack::mesh
