// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <variant>

#include "api/names.hpp"
#include "api/translations.hpp"
#include "errors/placed.hpp"

namespace anticrack::api {

using errors::Error;
using errors::Reason;
using Points = google::protobuf::RepeatedPtrField<v1::Point>;

// Enums travel as their numbers, except mesh::Preset.
static_assert(int(records::MeshState::failed) == v1::Mesh::STATE_FAILED);
static_assert(int(mesh::Kind::free) == v1::INTERFACE_KIND_FREE);
static_assert(int(records::ArrayType::uint8) == v1::ArrayLayout::TYPE_UINT8);

namespace {

/// The order of mesh::Preset, whose numbers are part of the identity of meshes.
constexpr std::array presets{v1::MESH_PRESET_GRADED, v1::MESH_PRESET_PAPER, v1::MESH_PRESET_UNIFORM,
                             v1::MESH_PRESET_COARSE};

}  // namespace

void Translation<mesh::Point>::write(const mesh::Point& value, v1::Point& to) {
  to.set_x(value[0]);
  to.set_y(value[1]);
}

mesh::Point Translation<mesh::Point>::read(const v1::Point& from) { return {from.x(), from.y()}; }

void Translation<std::vector<mesh::Point>>::write(const std::vector<mesh::Point>& value,
                                                  v1::Polyline& to) {
  write_field(value, to, "points");
}

std::vector<mesh::Point> Translation<std::vector<mesh::Point>>::read(const v1::Polyline& from) {
  std::vector<mesh::Point> points;
  read_field(from, "points", points);
  return points;
}

namespace {

using Through = Translation<std::vector<mesh::Point>>;

/// Shape and points of a v1::InterfaceCurve or v1::Line that runs through its points.
template <class Curve>
void write_curve(mesh::Shape shape, const std::vector<mesh::Point>& points, Curve& to) {
  if (shape == mesh::Shape::polyline) return Through::write(points, *to.mutable_polyline());
  if (shape == mesh::Shape::spline) return Through::write(points, *to.mutable_spline());
  std::size_t i = 0;
  for (const char* point : {"from", "through", "to"})
    write_field(points.at(i++), *to.mutable_arc(), point);
}

template <class Curve, class Spec>
void read_curve(const Curve& from, Spec& value) {
  switch (from.shape_case()) {
    case Curve::kPolyline:
      value.points = Through::read(from.polyline());
      return;
    case Curve::kSpline:
      value.shape = mesh::Shape::spline;
      value.points = Through::read(from.spline());
      return;
    case Curve::kArc:
      value.shape = mesh::Shape::arc;
      for (const char* point : {"from", "through", "to"})
        value.points.push_back(
            errors::below("arc", [&] { return read_one<mesh::Point>(from.arc(), point); }));
      return;
    default:
      break;
  }
  throw Error(Reason::invalid_argument, "a line is a polyline, an arc or a spline; set one")
      .at("polyline");
}

/// The middle of a v1::Segment or v1::Circle.
template <class Shape>
mesh::Point center_of(const Shape& from, const char* name) {
  return errors::below(name, [&] { return read_one<mesh::Point>(from, "center"); });
}

/// An inclusion, crack or region is given by itself, in `own`, or by a point or part of others,
/// which is read into `place`.
template <class Spec, class Place>
void read_place(const Message& from, const Spec& own, const char* own_name, const char* name,
                Place& place) {
  if (!own) return read_field(from, name, place);
  if (!has(from, field_of(from, name))) return;
  throw Error(Reason::invalid_argument, "{} and {} are both set; set one of them", own_name, name)
      .at(own_name);
}

}  // namespace

void Translation<mesh::InterfaceSpec>::write(const mesh::InterfaceSpec& value,
                                             v1::InterfaceCurve& to) {
  write_fields(value, to, {"shape", "points"});
  write_curve(value.shape, value.points, to);
}

mesh::InterfaceSpec Translation<mesh::InterfaceSpec>::read(const v1::InterfaceCurve& from) {
  mesh::InterfaceSpec value;
  read_fields(from, value, {"shape", "points"});
  read_curve(from, value);
  return value;
}

void Translation<mesh::LineSpec>::write(const mesh::LineSpec& value, v1::Line& to) {
  if (value.shape != mesh::Shape::segment) return write_curve(value.shape, value.points, to);
  v1::Segment& segment = *to.mutable_segment();
  write_field(value.points.at(0), segment, "center");
  segment.set_angle(value.angle);
  segment.set_length(value.length);
}

mesh::LineSpec Translation<mesh::LineSpec>::read(const v1::Line& from) {
  mesh::LineSpec value;
  if (!from.has_segment()) {
    read_curve(from, value);
    return value;
  }
  value.shape = mesh::Shape::segment;
  value.points = {center_of(from.segment(), "segment")};
  value.angle = from.segment().angle();
  value.length = from.segment().length();
  return value;
}

void Translation<mesh::OutlineSpec>::write(const mesh::OutlineSpec& value, v1::Outline& to) {
  if (value.shape == mesh::Shape::polyline)
    return Through::write(value.points, *to.mutable_polygon());
  if (value.shape == mesh::Shape::spline) return Through::write(value.points, *to.mutable_spline());
  write_field(value.points.at(0), *to.mutable_circle(), "center");
  to.mutable_circle()->set_radius(value.radius);
}

mesh::OutlineSpec Translation<mesh::OutlineSpec>::read(const v1::Outline& from) {
  switch (from.shape_case()) {
    case v1::Outline::kPolygon:
      return {mesh::Shape::polyline, Through::read(from.polygon())};
    case v1::Outline::kSpline:
      return {mesh::Shape::spline, Through::read(from.spline())};
    case v1::Outline::kCircle:
      return {mesh::Shape::circle, {center_of(from.circle(), "circle")}, from.circle().radius()};
    case v1::Outline::SHAPE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "an outline is a circle, a polygon or a spline; set one")
      .at("polygon");
}

void Translation<mesh::CrackSpec>::write(const mesh::CrackSpec& value, v1::Crack& to) {
  write_fields(value, to, {"part"});
  if (!value.line) write_field(value.part, to, "part");
}

mesh::CrackSpec Translation<mesh::CrackSpec>::read(const v1::Crack& from) {
  mesh::CrackSpec value;
  read_fields(from, value, {"part"});
  read_place(from, value.line, "line", "part", value.part);
  return value;
}

void Translation<mesh::RegionSpec>::write(const mesh::RegionSpec& value, v1::Region& to) {
  write_fields(value, to, {"at"});
  if (!value.outline) write_field(value.at, to, "at");
}

mesh::RegionSpec Translation<mesh::RegionSpec>::read(const v1::Region& from) {
  mesh::RegionSpec value;
  read_fields(from, value, {"at"});
  read_place(from, value.outline, "outline", "at", value.at);
  return value;
}

void Translation<mesh::InclusionSpec>::write(const mesh::InclusionSpec& value, v1::Inclusion& to) {
  write_fields(value, to, {"part", "delaminated", "motion", "stretches"});
  if (!value.line) write_field(value.part, to, "part");
  write_fields(value.motion, to);
  if (value.delaminated.empty() && value.stretches.empty()) {
    to.set_delaminated(false);
  } else {
    v1::InterfaceParts& parts = *to.mutable_delaminated_parts();
    write_field(value.delaminated, parts, "parts");
    write_field(value.stretches, parts, "stretches");
  }
}

mesh::InclusionSpec Translation<mesh::InclusionSpec>::read(const v1::Inclusion& from) {
  mesh::InclusionSpec value;
  read_fields(from, value, {"part", "delaminated", "motion", "stretches"});
  read_place(from, value.line, "line", "part", value.part);
  read_fields(from, value.motion);
  if (!from.has_delaminated_parts()) {
    const bool whole = !from.has_delaminated() || from.delaminated();
    if (!whole) return value;
    if (value.line)
      value.stretches = {{0, 1}};
    else
      value.delaminated = {value.part};
    return value;
  }
  const v1::InterfaceParts& parts = from.delaminated_parts();
  errors::below("delaminated_parts", [&] {
    if (parts.parts().empty() && parts.stretches().empty()) {
      throw Error(Reason::invalid_argument,
                  "no part is named; set delaminated = false for a bonded inclusion")
          .at("parts");
    }
    read_field(parts, "parts", value.delaminated);
    read_field(parts, "stretches", value.stretches);
  });
  return value;
}

void Translation<mesh::MeshOptions>::write(const mesh::MeshOptions& value, v1::MeshOptions& to) {
  write_fields(value, to, {"preset"});
  to.set_preset(presets.at(static_cast<std::size_t>(value.preset)));
  if (value.size == 0) to.clear_size();
  if (value.tip_size == 0) to.clear_tip_size();
  if (value.chord_angle == 0) to.clear_chord_angle();
  if (value.grading == mesh::MeshOptions().grading) to.clear_grading();
}

mesh::MeshOptions Translation<mesh::MeshOptions>::read(const v1::MeshOptions& from) {
  mesh::MeshOptions value;
  read_fields(from, value, {"preset"});
  const int preset = get_number(from, field_of(from, "preset"), -1);
  for (std::size_t i = 0; i < presets.size(); ++i)
    if (presets[i] == preset) value.preset = static_cast<mesh::Preset>(i);
  for (const char* length : {"size", "tip_size", "chord_angle"}) {
    if (has(from, field_of(from, length)) && get<double>(from, field_of(from, length), -1) == 0) {
      throw Error(Reason::invalid_argument, "0 is not above 0; leave it unset for the default")
          .at(length);
    }
  }
  return value;
}

void Translation<records::Refinement>::write(const records::Refinement& value, v1::Refinement& to) {
  write_fields(value, to, {"parent", "job"});
  to.set_parent(mesh_name(value.parent));
  to.set_job(job_name(value.job));
}

records::Refinement Translation<records::Refinement>::read(const v1::Refinement& from) {
  return {after_slash(from.parent(), "parent"), after_slash(from.job(), "job"),
          from.levels_sha256()};
}

void write_definition(const records::MeshDefinition& value, Message& to) {
  if (const auto* upload = std::get_if<records::UploadRef>(&value)) {
    write_field(upload_name(upload->sha256), to, "upload");
    write_field(upload->options, to, "options");
  } else if (const auto* refinement = std::get_if<records::Refinement>(&value)) {
    write_field(*refinement, to, "refinement");
  } else {
    write_fields(std::get<records::GeometrySource>(value), to);
  }
}

records::MeshDefinition read_definition(const v1::CreateMeshRequest& from) {
  switch (from.source_case()) {
    case v1::CreateMeshRequest::kGeometry: {
      records::GeometrySource source;
      read_fields(from, source);
      return source;
    }
    case v1::CreateMeshRequest::kUpload: {
      const auto options = read_one<mesh::MeshOptions>(from, "options");
      return records::UploadRef{after_slash(from.upload(), "upload"), options};
    }
    case v1::CreateMeshRequest::SOURCE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "a mesh is made from a geometry or an upload; set one")
      .at("geometry");
}

void Translation<records::MeshRecord>::write(const records::MeshRecord& value, v1::Mesh& to) {
  write_fields(value, to, {"id", "definition", "created", "for_job"});
  if (value.bisection_bound == 0) to.clear_bisection_bound();
  to.set_name(mesh_name(value.id));
  write_field(value.created, to, "create_time");
}

records::MeshRecord Translation<records::MeshRecord>::read(const v1::Mesh& from) {
  records::MeshRecord value;
  read_fields(from, value, {"id", "definition", "created", "for_job"});
  value.id = after_slash(from.name(), "name");
  read_field(from, "create_time", value.created);
  return value;
}

v1::BlockLayout layout_of(std::span<const records::ArrayLayout> arrays, std::uint64_t size,
                          const std::string& sha256) {
  v1::BlockLayout layout;
  layout.set_size(size);
  layout.set_sha256(sha256);
  for (const records::ArrayLayout& array : arrays)
    Translation<records::ArrayLayout>::write(array, *layout.add_arrays());
  return layout;
}

v1::BlockLayout layout_of(const records::BlockSource& block, std::size_t first, std::size_t count) {
  const std::span<const records::ArrayLayout> all(block.arrays());
  v1::BlockLayout layout = layout_of(all.subspan(first, std::min(count, all.size() - first)),
                                     block.size(), block.sha256());
  layout.set_first_array(static_cast<std::uint32_t>(first));
  layout.set_array_count(static_cast<std::uint32_t>(all.size()));
  return layout;
}

}  // namespace anticrack::api
