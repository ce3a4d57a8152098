// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <variant>

#include "api/names.hpp"
#include "api/translations.hpp"

namespace anticrack::api {

using errors::Error;
using errors::Reason;
using Points = google::protobuf::RepeatedPtrField<v1::Point>;

// Enums travel as their numbers, but for mesh::Preset.
static_assert(int(store::MeshState::failed) == v1::Mesh::STATE_FAILED);
static_assert(int(mesh::Kind::free) == v1::INTERFACE_KIND_FREE);
static_assert(int(store::ArrayType::uint8) == v1::ArrayLayout::TYPE_UINT8);

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

using Line = Translation<std::vector<mesh::Point>>;

void Translation<mesh::InterfaceSpec>::write(const mesh::InterfaceSpec& value,
                                             v1::InterfaceCurve& to) {
  write_fields(value, to, {"shape", "points"});
  switch (value.shape) {
    case mesh::Shape::polyline:
      return Line::write(value.points, *to.mutable_polyline());
    case mesh::Shape::spline:
      return Line::write(value.points, *to.mutable_spline());
    case mesh::Shape::arc:
      break;
  }
  int i = 0;
  for (const char* point : {"from", "through", "to"})
    write_field(value.points.at(static_cast<std::size_t>(i++)), *to.mutable_arc(), point);
}

mesh::InterfaceSpec Translation<mesh::InterfaceSpec>::read(const v1::InterfaceCurve& from) {
  mesh::InterfaceSpec value;
  read_fields(from, value, {"shape", "points"});
  switch (from.shape_case()) {
    case v1::InterfaceCurve::kPolyline:
      value.points = Line::read(from.polyline());
      return value;
    case v1::InterfaceCurve::kSpline:
      value.shape = mesh::Shape::spline;
      value.points = Line::read(from.spline());
      return value;
    case v1::InterfaceCurve::kArc:
      value.shape = mesh::Shape::arc;
      for (const char* point : {"from", "through", "to"}) {
        try {
          value.points.push_back(read_one<mesh::Point>(from.arc(), point));
        } catch (Error& error) {
          throw error.below("arc");
        }
      }
      return value;
    case v1::InterfaceCurve::SHAPE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "an interface is a polyline, an arc or a spline; set one")
      .at("polyline");
}

void Translation<mesh::InclusionSpec>::write(const mesh::InclusionSpec& value, v1::Inclusion& to) {
  write_fields(value, to, {"delaminated", "motion"});
  write_fields(value.motion, to);
  if (value.delaminated.empty()) {
    to.set_delaminated(false);
  } else {
    v1::InterfaceParts& parts = *to.mutable_delaminated_parts();
    write_field(value.delaminated, parts, "parts");
  }
}

mesh::InclusionSpec Translation<mesh::InclusionSpec>::read(const v1::Inclusion& from) {
  mesh::InclusionSpec value;
  read_fields(from, value, {"delaminated", "motion"});
  read_fields(from, value.motion);
  if (!from.has_delaminated_parts()) {
    const bool whole = !from.has_delaminated() || from.delaminated();
    if (whole) value.delaminated = {value.part};
    return value;
  }
  const v1::InterfaceParts& parts = from.delaminated_parts();
  try {
    if (parts.parts().empty()) {
      throw Error(Reason::invalid_argument,
                  "no part is named; set delaminated = false for a bonded inclusion")
          .at("parts");
    }
    read_field(parts, "parts", value.delaminated);
  } catch (Error& error) {
    throw error.below("delaminated_parts");
  }
  return value;
}

void Translation<mesh::MeshOptions>::write(const mesh::MeshOptions& value, v1::MeshOptions& to) {
  write_fields(value, to, {"preset"});
  to.set_preset(presets.at(static_cast<std::size_t>(value.preset)));
  if (value.size == 0) to.clear_size();
  if (value.tip_size == 0) to.clear_tip_size();
  if (value.grading == mesh::MeshOptions().grading) to.clear_grading();
}

mesh::MeshOptions Translation<mesh::MeshOptions>::read(const v1::MeshOptions& from) {
  mesh::MeshOptions value;
  read_fields(from, value, {"preset"});
  const int preset = get_number(from, field_of(from, "preset"), -1);
  for (std::size_t i = 0; i < presets.size(); ++i)
    if (presets[i] == preset) value.preset = static_cast<mesh::Preset>(i);
  for (const char* length : {"size", "tip_size"}) {
    if (has(from, field_of(from, length)) && get<double>(from, field_of(from, length), -1) == 0) {
      throw Error(Reason::invalid_argument, "0 is not above 0; leave it unset for the default")
          .at(length);
    }
  }
  return value;
}

void Translation<store::Refinement>::write(const store::Refinement& value, v1::Refinement& to) {
  write_fields(value, to, {"parent", "job"});
  to.set_parent(mesh_name(value.parent));
  to.set_job(job_name(value.job));
}

store::Refinement Translation<store::Refinement>::read(const v1::Refinement& from) {
  return {after_slash(from.parent(), "parent"), after_slash(from.job(), "job"),
          from.levels_sha256()};
}

void write_definition(const store::MeshDefinition& value, Message& to) {
  if (const auto* upload = std::get_if<store::UploadRef>(&value)) {
    write_field(upload_name(upload->sha256), to, "upload");
    write_field(upload->options, to, "options");
  } else if (const auto* refinement = std::get_if<store::Refinement>(&value)) {
    write_field(*refinement, to, "refinement");
  } else {
    write_fields(std::get<store::GeometrySource>(value), to);
  }
}

store::MeshDefinition read_definition(const v1::CreateMeshRequest& from) {
  switch (from.source_case()) {
    case v1::CreateMeshRequest::kGeometry: {
      store::GeometrySource source;
      read_fields(from, source);
      return source;
    }
    case v1::CreateMeshRequest::kUpload: {
      const auto options = read_one<mesh::MeshOptions>(from, "options");
      return store::UploadRef{after_slash(from.upload(), "upload"), options};
    }
    case v1::CreateMeshRequest::SOURCE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "a mesh is made from a geometry or an upload; set one")
      .at("geometry");
}

void Translation<store::MeshRecord>::write(const store::MeshRecord& value, v1::Mesh& to) {
  write_fields(value, to, {"id", "definition", "created"});
  if (value.theta_star == 0) to.clear_theta_star();
  if (value.bisection_bound == 0) to.clear_bisection_bound();
  to.set_name(mesh_name(value.id));
  write_field(value.created, to, "create_time");
}

store::MeshRecord Translation<store::MeshRecord>::read(const v1::Mesh& from) {
  store::MeshRecord value;
  read_fields(from, value, {"id", "definition", "created"});
  value.id = after_slash(from.name(), "name");
  read_field(from, "create_time", value.created);
  return value;
}

v1::BlockLayout layout_of(std::span<const store::ArrayLayout> arrays, std::uint64_t size,
                          const std::string& sha256) {
  v1::BlockLayout layout;
  layout.set_size(size);
  layout.set_sha256(sha256);
  for (const store::ArrayLayout& array : arrays)
    Translation<store::ArrayLayout>::write(array, *layout.add_arrays());
  return layout;
}

v1::BlockLayout layout_of(const store::BlockSource& block, std::size_t first, std::size_t count) {
  const std::span<const store::ArrayLayout> all(block.arrays());
  v1::BlockLayout layout = layout_of(all.subspan(first, std::min(count, all.size() - first)),
                                     block.size(), block.sha256());
  layout.set_first_array(static_cast<std::uint32_t>(first));
  layout.set_array_count(static_cast<std::uint32_t>(all.size()));
  return layout;
}

}  // namespace anticrack::api
