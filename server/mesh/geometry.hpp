// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parametric geometry of a case: a polygon, interfaces in it, what lies on them. Pure data and
// checks, without the mesher.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "fields/fields.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

/// The stretch of an interface between two of its points, given in either order; on a closed
/// interface the stretch from `from` to `to` in the interface's direction.
struct Part {
  Point from{};
  Point to{};
};
ANTICRACK_FIELDS(Part, from, to)

enum class Shape { polyline, arc, spline };

/// A line in the membrane, plus side on its left. Ends on the boundary, on another interface, or
/// free: see InterfaceCurve of the API.
struct InterfaceSpec {
  std::string name;
  Shape shape = Shape::polyline;
  std::vector<Point> points;  ///< polyline, spline: through all; arc: from, through, to
  bool closed = false;        ///< polyline and spline only
};
ANTICRACK_FIELDS(InterfaceSpec, name, shape, points, closed)

struct InclusionSpec {
  std::string name;
  Part part;
  std::vector<Part> delaminated;  ///< parts of `part`; the rest is bonded. {part}: all delaminated
  Motion motion{};
};
ANTICRACK_FIELDS(InclusionSpec, name, part, delaminated, motion)
inline const auto& added_field(const InclusionSpec& of) { return of.motion; }

struct CrackSpec {
  std::string name;
  Part part;
  bool contact = true;  ///< [u] >= 0; false: its faces are free
};
ANTICRACK_FIELDS(CrackSpec, name, part, contact)
inline const auto& added_field(const CrackSpec& of) { return of.contact; }

struct RegionSpec {
  std::string name;
  Point at{};          ///< inside the subdomain it names
  double tension = 1;  ///< T > 0
};
ANTICRACK_FIELDS(RegionSpec, name, at, tension)

struct Geometry {
  std::vector<Point> boundary;  ///< simple polygon, not closed, either orientation
  std::vector<InterfaceSpec> interfaces;
  std::vector<InclusionSpec> inclusions;
  std::vector<CrackSpec> cracks;
  std::vector<Part> neumann;  ///< of the boundary, counterclockwise; from == to: all of it
  std::vector<RegionSpec> regions;
};
ANTICRACK_FIELDS(Geometry, boundary, interfaces, inclusions, cracks, neumann, regions)

/// Coarse: graded, from a default size four times as large.
enum class Preset { graded, paper, uniform, coarse };
constexpr bool graded(Preset preset) noexcept {
  return preset == Preset::graded || preset == Preset::coarse;
}

struct MeshOptions {
  Preset preset = Preset::graded;
  double size = 0;       ///< edge length away from tips; 0: chosen, see MeshOptions of the API
  double tip_size = 0;   ///< graded: smallest edge wanted; 0: chosen, see mesh/refine.hpp
  double grading = 0.2;  ///< graded: m
  std::vector<std::vector<Point>> align{};  ///< geometry: lines that edges must follow
  // An upload's:
  std::map<std::int32_t, std::string>
      curve_groups{};  ///< physical tag -> "crack", "inclusion:NAME"...
  std::map<std::int32_t, std::string> surface_groups{};  ///< physical tag -> subdomain
  std::map<std::string, double> tension{};               ///< subdomain -> T
  std::map<std::string, Motion> inclusion_motions{};     ///< inclusion -> how it moves
};
ANTICRACK_FIELDS(MeshOptions, preset, size, tip_size, grading, align, curve_groups, surface_groups,
                 tension, inclusion_motions)
inline const auto& added_field(const MeshOptions& of) { return of.inclusion_motions; }

/// What a straight curve of the plan is.
enum class Role : std::int32_t { dirichlet, neumann, interface, align };

/// From points[a] to points[b], cut into `intervals` equal pieces.
struct PlannedCurve {
  int a = 0;
  int b = 0;
  int intervals = 1;
  Role role = Role::dirichlet;
  int left = -1;   ///< face on the left of a-b, -1: outside the membrane
  int right = -1;  ///< and on its right; equal to `left` for a curve inside a face
  // of an interface:
  Kind kind = Kind::glue;
  int inclusion = -1;
};
ANTICRACK_FIELDS(PlannedCurve, a, b, intervals, role, left, right, kind, inclusion)

/// A chain of curves, each from a to b, end to start; plus side on the left.
struct PlannedInterface {
  std::string name;
  std::vector<int> curves;
};
ANTICRACK_FIELDS(PlannedInterface, name, curves)

/// A face of the arrangement of all curves. Faces separated by align lines only are one subdomain,
/// share its name and tension, and follow each other. Loops hold +-(curve index + 1), negative
/// where they walk from b to a.
struct PlannedFace {
  std::string name;
  double tension = 1;
  std::vector<int> outer;               ///< counterclockwise, the face on its left
  std::vector<std::vector<int>> holes;  ///< clockwise, the face on its left
  std::vector<int> embedded;            ///< indices of curves inside it that bound no other face
};
ANTICRACK_FIELDS(PlannedFace, name, tension, outer, holes, embedded)

/// How to grade a mesh; see mesh/refine.hpp. h0 = 0: no grading.
struct GradingSpec {
  double h0 = 0;
  double m = 0.2;
  double tip_size = 0;
};
ANTICRACK_FIELDS(GradingSpec, h0, m, tip_size)

/// The mesher's input: the geometry cut into straight curves and faces.
struct Plan {
  std::vector<Point> points;
  std::vector<PlannedCurve> curves;
  std::vector<PlannedInterface> interfaces;
  std::vector<PlannedFace> faces;
  std::vector<std::string> inclusions;
  std::vector<Motion> motions;  ///< (inclusions)
  double growth = 0.3;          ///< how much longer edges become per length away from a finer curve
  GradingSpec grading;
  std::size_t triangles = 0;            ///< to be expected, before grading
  std::vector<std::string> warnings{};  ///< for Mesh::warnings: points that were moved onto a line
};
ANTICRACK_FIELDS(Plan, points, curves, interfaces, faces, inclusions, motions, growth, grading,
                 triangles, warnings)

/// Checks a geometry and cuts it into curves with the intervals of the preset. Throws errors::Error
/// with the field at fault ("boundary", "interfaces[0].polyline", "inclusions[1].part.from",
/// "inclusions[0].fixed", "regions[0].at", "options.size", ...): geometry_invalid (the boundary
/// crosses itself, an interface leaves the membrane or runs along another, a part lies on no
/// interface, touches the Dirichlet boundary or overlaps another, values are not finite, names are
/// empty, malformed or used twice, a motion has a fault); invalid_argument for options;
/// limit_exceeded for more than 20,000 vertices or more than `max_triangles` expected triangles.
/// O(v^2) for v vertices.
Plan plan(const Geometry& geometry, const MeshOptions& options, std::size_t max_triangles);

/// Check the options of a geometry (all but the points of `align`, which plan() checks) and of an
/// upload, before a mesh is known. Throw errors::Error (invalid_argument) with the field at fault
/// ("options.size", "options.align", "options.curve_groups[3]", ...).
void check_for_geometry(const MeshOptions& options);
void check_for_upload(const MeshOptions& options);

}  // namespace anticrack::mesh
