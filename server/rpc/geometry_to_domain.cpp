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

void require_entries(int count, std::size_t limit, const std::string& field, const char* what) {
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

std::string indexed(const char* list, int i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

int vertex_count(const v1::InterfaceCurve& curve) {
  return curve.polyline().points_size() + curve.spline().points_size();
}

mesh::InterfaceSpec to_interface(const v1::InterfaceCurve& curve, const std::string& field) {
  mesh::InterfaceSpec spec;
  spec.name = curve.name();
  spec.closed = curve.closed();
  switch (curve.shape_case()) {
    case v1::InterfaceCurve::kPolyline:
      spec.points = to_points(curve.polyline().points());
      return spec;
    case v1::InterfaceCurve::kSpline:
      spec.shape = mesh::Shape::spline;
      spec.points = to_points(curve.spline().points());
      return spec;
    case v1::InterfaceCurve::kArc: {
      const v1::Arc& arc = curve.arc();
      const auto require = [&](bool has, const char* point) {
        if (!has) throw Error(Reason::invalid_argument, "missing").at(field + ".arc." + point);
      };
      require(arc.has_from(), "from");
      require(arc.has_through(), "through");
      require(arc.has_to(), "to");
      spec.shape = mesh::Shape::arc;
      spec.points = {to_point(arc.from()), to_point(arc.through()), to_point(arc.to())};
      return spec;
    }
    case v1::InterfaceCurve::SHAPE_NOT_SET:
      break;
  }
  throw Error(Reason::invalid_argument, "an interface is a polyline, an arc or a spline; set one")
      .at(field + ".polyline");
}

mesh::RegionSpec to_region(const v1::Region& region, const std::string& field) {
  if (!region.has_at()) throw Error(Reason::invalid_argument, "missing").at(field + ".at");
  // 0 is what an unset field reads as
  return {region.name(), to_point(region.at()), region.tension() == 0 ? 1 : region.tension()};
}

mesh::Part to_boundary_part(const v1::BoundaryPart& part, const std::string& field) {
  if (!part.has_from()) throw Error(Reason::invalid_argument, "missing").at(field + ".from");
  if (!part.has_to()) throw Error(Reason::invalid_argument, "missing").at(field + ".to");
  return {to_point(part.from()), to_point(part.to())};
}

void require_counts(const v1::Geometry& geometry) {
  require_entries(geometry.boundary_size(), max_vertices, "geometry.boundary", "vertices");
  require_entries(geometry.interfaces_size(), max_interfaces, "geometry.interfaces", "interfaces");
  std::size_t vertices = 0;
  for (int i = 0; i < geometry.interfaces_size(); ++i) {
    vertices += static_cast<std::size_t>(vertex_count(geometry.interfaces(i)));
    if (vertices > max_vertices) {
      throw Error(Reason::limit_exceeded, "more than " + std::to_string(max_vertices) +
                                              " points in all interfaces together")
          .at(indexed("geometry.interfaces", i));
    }
  }
  require_entries(part_count(geometry), max_parts, "geometry.inclusions",
                  "inclusions, cracks and delaminated parts");
  require_entries(geometry.neumann_size(), max_parts, "geometry.neumann", "parts of the boundary");
  require_entries(geometry.regions_size(), max_regions, "geometry.regions", "regions");
}

mesh::Geometry to_geometry(const v1::Geometry& geometry) {
  require_counts(geometry);
  mesh::Geometry result;
  result.boundary = to_points(geometry.boundary());
  result.interfaces.reserve(static_cast<std::size_t>(geometry.interfaces_size()));
  for (int i = 0; i < geometry.interfaces_size(); ++i) {
    result.interfaces.push_back(
        to_interface(geometry.interfaces(i), indexed("geometry.interfaces", i)));
  }
  result.inclusions.reserve(static_cast<std::size_t>(geometry.inclusions_size()));
  for (int i = 0; i < geometry.inclusions_size(); ++i) {
    result.inclusions.push_back(
        to_inclusion(geometry.inclusions(i), indexed("geometry.inclusions", i)));
  }
  result.cracks.reserve(static_cast<std::size_t>(geometry.cracks_size()));
  for (int i = 0; i < geometry.cracks_size(); ++i) {
    const std::string field = indexed("geometry.cracks", i) + ".part";
    result.cracks.push_back({geometry.cracks(i).name(), to_part(geometry.cracks(i).part(), field)});
  }
  result.neumann.reserve(static_cast<std::size_t>(geometry.neumann_size()));
  for (int i = 0; i < geometry.neumann_size(); ++i) {
    result.neumann.push_back(to_boundary_part(geometry.neumann(i), indexed("geometry.neumann", i)));
  }
  result.regions.reserve(static_cast<std::size_t>(geometry.regions_size()));
  for (int i = 0; i < geometry.regions_size(); ++i) {
    result.regions.push_back(to_region(geometry.regions(i), indexed("geometry.regions", i)));
  }
  return result;
}

mesh::Preset to_preset(v1::MeshPreset preset) {
  switch (preset) {
    case v1::MESH_PRESET_UNSPECIFIED:
    case v1::MESH_PRESET_GRADED:
      return mesh::Preset::graded;
    case v1::MESH_PRESET_PAPER:
      return mesh::Preset::paper;
    case v1::MESH_PRESET_UNIFORM:
      return mesh::Preset::uniform;
    default:
      throw Error(Reason::invalid_argument,
                  "preset " + std::to_string(preset) +
                      " is unknown; use paper (1), uniform (2) or graded (3)")
          .at("options.preset");
  }
}

mesh::MeshOptions to_mesh_options(const v1::MeshOptions& options) {
  require_entries(options.align_size(), max_interfaces, "options.align", "lines");
  std::size_t vertices = 0;
  for (const v1::Polyline& line : options.align()) {
    vertices += static_cast<std::size_t>(line.points_size());
  }
  require_entries(static_cast<int>(vertices), max_vertices, "options.align", "vertices");
  const auto entries = [](const auto& map) { return static_cast<int>(map.size()); };
  require_entries(entries(options.curve_groups()), max_regions, "options.curve_groups", "groups");
  require_entries(entries(options.surface_groups()), max_regions, "options.surface_groups",
                  "groups");
  require_entries(entries(options.tension()), max_regions, "options.tension", "subdomains");
  mesh::MeshOptions result;
  result.preset = to_preset(options.preset());
  result.size = options.size();
  result.tip_size = options.tip_size();
  if (options.grading() != 0) result.grading = options.grading();
  result.align.reserve(static_cast<std::size_t>(options.align_size()));
  for (const v1::Polyline& line : options.align()) result.align.push_back(to_points(line.points()));
  result.curve_groups.insert(options.curve_groups().begin(), options.curve_groups().end());
  result.surface_groups.insert(options.surface_groups().begin(), options.surface_groups().end());
  result.tension.insert(options.tension().begin(), options.tension().end());
  return result;
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
      return store::GeometrySource{to_geometry(request.geometry()),
                                   to_mesh_options(request.options())};
    case v1::CreateMeshRequest::kUpload: {
      mesh::MeshOptions options = to_mesh_options(request.options());
      mesh::check_for_upload(options);
      return store::UploadRef{upload_sha256(request.upload(), "upload"), std::move(options)};
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
    if (own) return field;
    // the request has a message around the list
    const std::string list = ".delaminated_parts";
    std::string path = "geometry." + field;
    const std::size_t at = path.find(list);
    if (at != std::string::npos) path.insert(at + list.size(), ".parts");
    return path;
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
