// SPDX-License-Identifier: GPL-3.0-or-later
#include <google/protobuf/repeated_field.h>

#include <string>
#include <utility>

#include "rpc/names.hpp"
#include "rpc/to_domain.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;
using Points = google::protobuf::RepeatedPtrField<v1::Point>;

void require_count(int count, std::size_t limit, const std::string& field, const char* what) {
  if (static_cast<std::size_t>(count) > limit) {
    throw Error(Reason::limit_exceeded, std::to_string(count) + " " + what + ": at most " +
                                            std::to_string(limit) + " are accepted")
        .at(field);
  }
}

mesh::Point to_point(const v1::Point& point) {
  return {point.x(), point.y()};
}

std::vector<mesh::Point> to_points(const Points& points) {
  std::vector<mesh::Point> result;
  result.reserve(static_cast<std::size_t>(points.size()));
  for (const v1::Point& point : points) result.push_back(to_point(point));
  return result;
}

mesh::Part to_part(const v1::InterfacePart& part, const std::string& field) {
  if (!part.has_from()) throw Error(Reason::invalid_argument, "missing").at(field + ".from");
  if (!part.has_to()) throw Error(Reason::invalid_argument, "missing").at(field + ".to");
  return {to_point(part.from()), to_point(part.to())};
}

mesh::InclusionSpec to_inclusion(const v1::Inclusion& inclusion, const std::string& field) {
  mesh::InclusionSpec spec;
  spec.name = inclusion.name();
  spec.part = to_part(inclusion.part(), field + ".part");
  switch (inclusion.delamination_case()) {
    case v1::Inclusion::DELAMINATION_NOT_SET:
      spec.delaminated = {spec.part};
      break;
    case v1::Inclusion::kDelaminated:
      if (inclusion.delaminated()) spec.delaminated = {spec.part};
      break;
    case v1::Inclusion::kDelaminatedParts: {
      const std::string parts_field = field + ".delaminated_parts.parts";
      const auto& parts = inclusion.delaminated_parts().parts();
      if (parts.empty()) {
        throw Error(Reason::invalid_argument,
                    "no part is named; set delaminated = false for a bonded inclusion")
            .at(parts_field);
      }
      for (int i = 0; i < parts.size(); ++i) {
        spec.delaminated.push_back(
            to_part(parts.Get(i), parts_field + "[" + std::to_string(i) + "]"));
      }
      break;
    }
  }
  return spec;
}

int part_count(const v1::Geometry& geometry) {
  int count = geometry.inclusions_size() + geometry.cracks_size();
  for (const v1::Inclusion& inclusion : geometry.inclusions()) {
    count += inclusion.delaminated_parts().parts_size();
  }
  return count;
}

mesh::Geometry to_geometry(const v1::Geometry& geometry) {
  require_count(geometry.boundary_size(), max_vertices, "geometry.boundary", "vertices");
  require_count(geometry.interface().points_size(), max_vertices, "geometry.interface.points",
                "points");
  require_count(part_count(geometry), max_parts, "geometry.inclusions",
                "inclusions, cracks and delaminated parts");
  mesh::Geometry result;
  result.boundary = to_points(geometry.boundary());
  result.interface = to_points(geometry.interface().points());
  for (int i = 0; i < geometry.inclusions_size(); ++i) {
    const std::string field = "geometry.inclusions[" + std::to_string(i) + "]";
    result.inclusions.push_back(to_inclusion(geometry.inclusions(i), field));
  }
  for (int i = 0; i < geometry.cracks_size(); ++i) {
    const std::string field = "geometry.cracks[" + std::to_string(i) + "].part";
    result.cracks.push_back({geometry.cracks(i).name(), to_part(geometry.cracks(i).part(), field)});
  }
  return result;
}

mesh::MeshOptions to_options(const v1::MeshOptions& options) {
  mesh::MeshOptions result;
  result.size = options.size();
  switch (options.preset()) {
    case v1::MESH_PRESET_UNSPECIFIED:
    case v1::MESH_PRESET_PAPER:
      result.preset = mesh::Preset::paper;
      return result;
    case v1::MESH_PRESET_UNIFORM:
      result.preset = mesh::Preset::uniform;
      return result;
    case v1::MESH_PRESET_GRADED:
      throw Error(Reason::not_implemented,
                  "the graded preset is not in this version; use paper or uniform")
          .at("options.preset");
    default:
      throw Error(Reason::invalid_argument, "preset " + std::to_string(options.preset()) +
                                                " is unknown; use paper (1) or uniform (2)")
          .at("options.preset");
  }
}

/// A copy of `error` whose fields are `rename(field)`.
template <class Rename>
Error renamed(const Error& error, Rename rename) {
  Error result(error.reason(), error.what());
  for (const errors::FieldViolation& violation : error.fields()) {
    result.at(rename(violation.field));
  }
  for (const auto& [key, value] : error.metadata()) result.with(key, value);
  result.retry_after(error.retry_delay());
  return result;
}

}  // namespace

store::MeshDefinition to_definition(const v1::CreateMeshRequest& request) {
  require_title(request.title(), "title");
  switch (request.source_case()) {
    case v1::CreateMeshRequest::kGeometry:
      return store::GeometrySource{to_geometry(request.geometry()), to_options(request.options())};
    case v1::CreateMeshRequest::kUpload: {
      const bool options = request.options().preset() != v1::MESH_PRESET_UNSPECIFIED ||
                           request.options().size() != 0;
      if (options) {
        throw Error(Reason::invalid_argument,
                    "options are for a geometry; an uploaded mesh is taken as it is")
            .at("options");
      }
      return store::UploadRef{upload_sha256(request.upload(), "upload")};
    }
    case v1::CreateMeshRequest::SOURCE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "a mesh is made from a geometry or an upload; set one")
      .at("geometry");
}

void require_title(const std::string& title, const char* field) {
  if (title.size() > max_title_bytes) {
    throw Error(Reason::limit_exceeded, "the title has " + std::to_string(title.size()) +
                                            " bytes: at most " + std::to_string(max_title_bytes) +
                                            " are accepted")
        .at(field);
  }
}

Error below_mesh_request(const Error& error) {
  Error result = renamed(error, [](const std::string& field) {
    const bool own = field.starts_with("options") || field.starts_with("upload");
    return own ? field : "geometry." + field;
  });
  if (result.fields().empty() && result.reason() == Reason::not_found) result.at("upload");
  return result;
}

Error below_job_request(const Error& error) {
  Error result = error;
  if (result.fields().empty() && result.reason() == Reason::not_found) result.at("mesh");
  if (result.reason() != Reason::request_id_reused) return result.below("job");
  return result.fields().empty() ? result.at("request_id") : result;
}

}  // namespace anticrack::rpc
