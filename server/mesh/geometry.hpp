// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parametric geometry of a case: a boundary, holes, interfaces, and what lies on these. Pure
// data and checks, without the mesher.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
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

enum class Shape { polyline, arc, spline, segment, circle };

/// A line with two ends, through `points`, or a segment.
struct LineSpec {
  Shape shape = Shape::polyline;  ///< no circle
  std::vector<Point> points;      ///< as of InterfaceSpec; segment: its middle
  double angle = 0;   ///< segment: its direction, degrees, counterclockwise from the x axis
  double length = 0;  ///< segment: > 0
  bool operator==(const LineSpec&) const = default;
};
ANTICRACK_FIELDS(LineSpec, shape, points, angle, length)

/// A closed line, either orientation.
struct OutlineSpec {
  Shape shape = Shape::polyline;  ///< or spline or circle
  std::vector<Point> points;      ///< the last is joined to the first; circle: its middle
  double radius = 0;              ///< circle: > 0
  bool operator==(const OutlineSpec&) const = default;
};
ANTICRACK_FIELDS(OutlineSpec, shape, points, radius)

/// A line in the membrane; its plus side is on its left. It ends on the boundary, on another
/// interface, or freely: see InterfaceCurve of the API.
struct InterfaceSpec {
  std::string name;
  Shape shape = Shape::polyline;  ///< no segment; a circle only within plan(): centre, radius
  std::vector<Point> points;      ///< polyline, spline: through all; arc: from, through, to
  bool closed = false;            ///< polyline and spline only
};
ANTICRACK_FIELDS(InterfaceSpec, name, shape, points, closed)

/// A stretch of a line, by arc length over the line's length: 0 <= from < to <= 1.
struct StretchSpec {
  double from = 0;
  double to = 0;
  bool operator==(const StretchSpec&) const = default;
};
ANTICRACK_FIELDS(StretchSpec, from, to)

/// A side of a line, walked from its start to its end. The numbers are those of the API.
enum class LineSide : std::int32_t { unspecified = 0, left = 1, right = 2 };

struct InclusionSpec {
  std::string name;
  Part part;                      ///< on an interface; ignored if `line` is set
  std::vector<Part> delaminated;  ///< parts of `part`; the rest is bonded. {part}: all delaminated
  Motion motion{};
  std::optional<LineSpec> line{};                     ///< its own interface, instead of `part`
  std::vector<StretchSpec> stretches{};               ///< further delaminated stretches of `line`
  LineSide delaminated_side = LineSide::unspecified;  ///< side that comes off; unset: minus
};
ANTICRACK_FIELDS(InclusionSpec, name, part, delaminated, motion, line, stretches, delaminated_side)

struct CrackSpec {
  std::string name;
  Part part;                       ///< as of an inclusion
  bool contact = true;             ///< [u] >= 0; false: its faces are free
  std::optional<LineSpec> line{};  ///< as of an inclusion
};
ANTICRACK_FIELDS(CrackSpec, name, part, contact, line)

struct RegionSpec {
  std::string name;
  Point at{};          ///< inside the subdomain that it names; ignored if `outline` is set
  double tension = 1;  ///< T > 0
  std::optional<OutlineSpec> outline{};     ///< around it: glue with its name
  std::optional<TensionLaw> tension_law{};  ///< in place of `tension`
};
ANTICRACK_FIELDS(RegionSpec, name, at, tension, outline, tension_law)

/// A side of the boundary, which begins where the one before it ends.
struct SideSpec {
  std::string name;  ///< empty: side-1, side-2, ...
  LineSpec line;
  bool operator==(const SideSpec&) const = default;
};
ANTICRACK_FIELDS(SideSpec, name, line)

/// A hole in the membrane, part of its boundary.
struct HoleSpec {
  std::string name;  ///< empty: hole-1, hole-2, ...
  OutlineSpec outline;
  bool operator==(const HoleSpec&) const = default;
};
ANTICRACK_FIELDS(HoleSpec, name, outline)

struct Geometry {
  std::vector<Point> boundary;  ///< simple polygon, not closed, either orientation
  std::vector<InterfaceSpec> interfaces;
  std::vector<InclusionSpec> inclusions;
  std::vector<CrackSpec> cracks;
  std::vector<Part> neumann;  ///< parts of the outer boundary, counterclockwise; from == to: all
  std::vector<RegionSpec> regions;
  std::vector<SideSpec> sides{};  ///< in place of `boundary`, either orientation
  std::vector<HoleSpec> holes{};
  std::vector<std::string> neumann_sides{};  ///< names of sides and holes
};
ANTICRACK_FIELDS(Geometry, boundary, interfaces, inclusions, cracks, neumann, regions, sides, holes,
                 neumann_sides)

/// `coarse` is `graded` with a default size four times as large.
enum class Preset { graded, paper, uniform, coarse };
constexpr bool graded(Preset preset) noexcept {
  return preset == Preset::graded || preset == Preset::coarse;
}

constexpr double default_chord_angle = 5;  ///< degrees

struct MeshOptions {
  Preset preset = Preset::graded;
  double size = 0;       ///< edge length away from tips; 0: chosen, see MeshOptions of the API
  double tip_size = 0;   ///< graded: smallest edge wanted; 0: chosen, see mesh/refine.hpp
  double grading = 0.2;  ///< graded: exponent m
  std::vector<std::vector<Point>> align{};  ///< geometry: lines that edges must follow
  // Options of an upload:
  std::map<std::int32_t, std::string>
      curve_groups{};  ///< physical tag -> "crack", "inclusion:NAME"...
  std::map<std::int32_t, std::string> surface_groups{};  ///< physical tag -> subdomain
  std::map<std::string, double> tension{};               ///< subdomain -> T
  std::map<std::string, Motion> inclusion_motions{};     ///< inclusion -> how it moves
  std::map<std::string, TensionLaw> tension_laws{};      ///< subdomain -> T, in place of a number
  double chord_angle = 0;  ///< geometry: largest turn of a chord of a curve, degrees; 0: default
};
ANTICRACK_FIELDS(MeshOptions, preset, size, tip_size, grading, align, curve_groups, surface_groups,
                 tension, inclusion_motions, tension_laws, chord_angle)

/// The role of a straight curve of the plan.
enum class Role : std::int32_t { dirichlet, neumann, interface, align };

/// A straight curve from points[a] to points[b], cut into `intervals` equal pieces.
struct PlannedCurve {
  int a = 0;
  int b = 0;
  int intervals = 1;
  Role role = Role::dirichlet;
  int left = -1;   ///< face on the left of a-b, -1: outside the membrane, or in a hole
  int right = -1;  ///< face on its right; equal to `left` for a curve inside a face
  // of an interface:
  Kind kind = Kind::glue;
  int inclusion = -1;
  // of a chord:
  int bend = -1;     ///< index into Plan::bends; -1: the curve lies on a straight line
  double from = 0;   ///< parameter of the bend at a
  double to = 0;     ///< at b
  double chord = 0;  ///< of a part of a chord, which stays straight: length of the whole; else 0
  int side = -1;     ///< of the boundary: index into Plan::sides

  /// Whether the curve is a whole chord, whose nodes may be put on its bend.
  bool bends() const noexcept { return bend >= 0 && chord == 0; }
};
ANTICRACK_FIELDS(PlannedCurve, a, b, intervals, role, left, right, kind, inclusion, bend, from, to,
                 chord, side)

/// A chain of curves from a to b, each beginning where the last ends; the plus side is on the left.
struct PlannedInterface {
  std::string name;
  std::vector<int> curves;
};
ANTICRACK_FIELDS(PlannedInterface, name, curves)

/// A face of the arrangement of all curves. Faces that only align lines separate are one subdomain:
/// they share its name, tension and law, and are consecutive. Loops hold +-(curve index + 1),
/// negative if they walk the curve from b to a.
struct PlannedFace {
  std::string name;
  double tension = 1;
  TensionLaw law;                       ///< in place of `tension`, if the face has a law
  std::vector<int> outer;               ///< counterclockwise, the face on its left
  std::vector<std::vector<int>> holes;  ///< clockwise, the face on its left
  std::vector<int> embedded;            ///< indices of curves inside it that bound no other face
};
ANTICRACK_FIELDS(PlannedFace, name, tension, law, outer, holes, embedded)

/// Parameters of the grading; see mesh/refine.hpp. h0 = 0: no grading.
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
  std::size_t triangles = 0;            ///< expected number, before grading
  std::vector<std::string> warnings{};  ///< for Mesh::warnings: points that were moved onto a line
  std::vector<Bend> bends{};            ///< of which curves are chords
  std::vector<std::string> sides{};     ///< names of the sides of the boundary, and of the holes
};
ANTICRACK_FIELDS(Plan, points, curves, interfaces, faces, inclusions, motions, growth, grading,
                 triangles, warnings, bends, sides)

/// Checks a geometry and cuts it into curves with the intervals of the preset. An interface is
/// walked against its direction where the plus side of an inclusion comes off instead of the minus
/// side. Throws errors::Error with the field at fault ("boundary", "sides[2].line",
/// "interfaces[0].polyline", "inclusions[1].part.from", "inclusions[1].line.segment",
/// "inclusions[0].fixed", "regions[0].at", "options.size", ...): geometry_invalid (the boundary
/// crosses itself or does not close, nothing is held, a hole lies outside or touches something, an
/// interface leaves the membrane or runs along another, a part lies on no interface or overlaps
/// another, ends where u is held on one side only, values are not finite, names are empty,
/// malformed, unknown or used twice, a motion has a fault); invalid_argument for options;
/// limit_exceeded for more than 20,000 vertices or more than `max_triangles` expected triangles.
/// O(v^2) for v vertices.
Plan plan(const Geometry& geometry, const MeshOptions& options, std::size_t max_triangles);

/// Check options before a mesh is known: those of a geometry (all but the points of `align`, which
/// plan() checks) and those of an upload. They throw errors::Error (invalid_argument) with the
/// field at fault ("options.size", "options.align", "options.curve_groups[3]", ...).
void check_for_geometry(const MeshOptions& options);
void check_for_upload(const MeshOptions& options);

}  // namespace anticrack::mesh
