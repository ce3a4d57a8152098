// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <string>
#include <variant>

#include "api/names.hpp"
#include "api/requests.hpp"
#include "api/translations.hpp"

namespace anticrack::api {
namespace {

using errors::Error;
using errors::Reason;

void require_count(std::size_t count, std::size_t limit, const char* field, const char* what) {
  if (count <= limit) return;
  throw Error(Reason::limit_exceeded, "{} {}: at most {} are accepted", count, what, limit)
      .at(field);
}

std::size_t part_count(const v1::Geometry& geometry) {
  auto count = static_cast<std::size_t>(geometry.inclusions_size() + geometry.cracks_size());
  for (const v1::Inclusion& inclusion : geometry.inclusions()) {
    const v1::InterfaceParts& parts = inclusion.delaminated_parts();
    count += static_cast<std::size_t>(parts.parts_size() + parts.stretches_size());
  }
  return count;
}

/// The number of vertices of a v1::InterfaceCurve or v1::Line.
template <class Line>
int vertex_count(const Line& line) {
  return line.polyline().points_size() + line.spline().points_size();
}
int vertex_count(const v1::Outline& line) {
  return line.polygon().points_size() + line.spline().points_size();
}

/// Counts the vertices of several lines together.
class Vertices {
 public:
  explicit Vertices(const char* what) : _what(what) {}
  void add(int count, const char* list, int index) {
    _count += static_cast<std::size_t>(count);
    if (_count <= max_vertices) return;
    throw Error(Reason::limit_exceeded, "more than {} points in all {} together", max_vertices,
                _what)
        .at(fmt::format("geometry.{}[{}]", list, index));
  }

 private:
  const char* _what;
  std::size_t _count = 0;
};

void require_vertices(const v1::Geometry& geometry) {
  Vertices boundary("sides and holes");
  for (int i = 0; i < geometry.sides_size(); ++i)
    boundary.add(vertex_count(geometry.sides(i).line()), "sides", i);
  for (int i = 0; i < geometry.holes_size(); ++i)
    boundary.add(vertex_count(geometry.holes(i).outline()), "holes", i);
  Vertices lines("interfaces");
  for (int i = 0; i < geometry.interfaces_size(); ++i)
    lines.add(vertex_count(geometry.interfaces(i)), "interfaces", i);
  for (int i = 0; i < geometry.inclusions_size(); ++i)
    lines.add(vertex_count(geometry.inclusions(i).line()), "inclusions", i);
  for (int i = 0; i < geometry.cracks_size(); ++i)
    lines.add(vertex_count(geometry.cracks(i).line()), "cracks", i);
  for (int i = 0; i < geometry.regions_size(); ++i)
    lines.add(vertex_count(geometry.regions(i).outline()), "regions", i);
}

void require_counts(const v1::Geometry& geometry) {
  require_count(geometry.boundary().size(), max_vertices, "geometry.boundary", "vertices");
  require_count(geometry.sides().size(), max_sides, "geometry.sides", "sides");
  require_count(geometry.holes().size(), max_sides, "geometry.holes", "holes");
  require_count(geometry.interfaces().size(), max_interfaces, "geometry.interfaces", "interfaces");
  require_count(part_count(geometry), max_parts, "geometry.inclusions",
                "inclusions, cracks and delaminated parts");
  require_count(geometry.neumann().size(), max_parts, "geometry.neumann", "parts of the boundary");
  require_count(geometry.neumann_sides().size(), 2 * max_sides, "geometry.neumann_sides",
                "sides and holes");
  require_count(geometry.regions().size(), max_regions, "geometry.regions", "regions");
  require_vertices(geometry);
}

void require_counts(const v1::MeshOptions& options) {
  require_count(options.align().size(), max_interfaces, "options.align", "lines");
  std::size_t vertices = 0;
  for (const v1::Polyline& line : options.align())
    vertices += static_cast<std::size_t>(line.points_size());
  require_count(vertices, max_vertices, "options.align", "vertices");
  require_count(options.curve_groups().size(), max_regions, "options.curve_groups", "groups");
  require_count(options.surface_groups().size(), max_regions, "options.surface_groups", "groups");
  require_count(options.tension().size(), max_regions, "options.tension", "subdomains");
  require_count(options.tension_laws().size(), max_regions, "options.tension_laws", "subdomains");
  require_count(options.inclusion_motions().size(), max_parts, "options.inclusion_motions",
                "inclusions");
}

}  // namespace

records::MeshDefinition to_definition(const v1::CreateMeshRequest& request) {
  require_title(request.title(), "title");
  require_counts(request.geometry());
  require_counts(request.options());
  records::MeshDefinition definition = read_definition(request);
  if (const auto* upload = std::get_if<records::UploadRef>(&definition)) {
    mesh::check_for_upload(upload->options);
    upload_sha256(request.upload(), "upload");
  }
  return definition;
}

void require_title(const std::string& title, const char* field) {
  if (title.size() <= max_title_bytes) return;
  throw Error(Reason::limit_exceeded, "the title has {} bytes: at most {} are accepted",
              title.size(), max_title_bytes)
      .at(field);
}

Error below_mesh_request(const Error& error) {
  Error result = error;
  result.rename([](const std::string& field) {
    const bool own = field.starts_with("options") || field.starts_with("upload");
    if (own) return field;
    // in the request, the list is inside a message
    const std::string list = ".delaminated_parts";
    std::string path = "geometry." + field;
    const std::size_t end = path.find(list) + list.size();
    if (path.find(list) != std::string::npos && (end == path.size() || path[end] == '['))
      path.insert(end, ".parts");
    return path;
  });
  if (result.fields().empty() && result.reason() == Reason::not_found) result.at("upload");
  return result;
}

Error below_job_request(const Error& error) {
  Error result = error;
  if (result.fields().empty() && result.reason() == Reason::not_found) result.at("mesh");
  if (result.reason() != Reason::request_id_reused) return result.below("spec");
  return result.fields().empty() ? result.at("request_id") : result;
}

}  // namespace anticrack::api
