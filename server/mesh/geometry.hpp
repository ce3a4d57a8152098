// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parametric geometry of a case: a polygon, an interface that cuts it, what lies on the
// interface. Pure data and checks; no mesher is needed to refuse a bad one.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace anticrack::mesh {

using Point = std::array<double, 2>;

/// From one point of the interface to another; either order.
struct Part {
  Point from{};
  Point to{};
};

struct InclusionSpec {
  std::string name;
  Part part;
  std::vector<Part> delaminated;  ///< parts of `part`; the rest is bonded. {part}: all delaminated
};

struct CrackSpec {
  std::string name;
  Part part;
};

struct Geometry {
  std::vector<Point> boundary;  ///< simple polygon, not closed, either orientation
  std::vector<Point>
      interface;  ///< ends on the boundary, the rest strictly inside; plus on its left
  std::vector<InclusionSpec> inclusions;
  std::vector<CrackSpec> cracks;
};

enum class Preset { paper, uniform };

struct MeshOptions {
  Preset preset = Preset::paper;
  double size = 0;  ///< edge length of `uniform`; 0: a fiftieth of the bounding box's diagonal
};

/// One straight curve of the plan: from points[a] to points[b], cut into `intervals` equal pieces.
struct PlannedCurve {
  int a = 0;
  int b = 0;
  int intervals = 1;
};

/// A curve of the interface, in order from its start.
struct PlannedInterfaceCurve : PlannedCurve {
  Kind kind = Kind::glue;
  int inclusion = -1;
};

/// What the mesher needs to know: the geometry cut into straight curves. Subdomain 0 is the minus
/// side (Omega_1), 1 the plus side (Omega_2).
struct Plan {
  std::vector<Point> points;
  std::array<std::vector<PlannedCurve>, 2> outer;  ///< of each subdomain, counterclockwise, open
  std::vector<PlannedInterfaceCurve> interface;
  std::vector<std::string> inclusions;
  double growth = 0.3;  ///< how much longer edges become per length away from a finer curve
};

/// Checks a geometry and cuts it into curves with the intervals of the preset.
/// Throws errors::Error (geometry_invalid; invalid_argument for options; limit_exceeded for too
/// many vertices or triangles) with the field at fault
/// ("boundary", "interface", "inclusions[1].part.from", "options.size", ...): boundary that crosses
/// itself, interface that does not cut the polygon in two, inclusion off the interface, touching
/// the boundary, or overlapping another, values not finite, names empty, wrong or used twice,
/// more triangles than `max_triangles` to be expected. O(v^2) in the vertices, at most 10,000.
Plan plan(const Geometry& geometry, const MeshOptions& options, std::size_t max_triangles);

}  // namespace anticrack::mesh
