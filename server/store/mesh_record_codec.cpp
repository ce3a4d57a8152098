// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>
#include <variant>

#include "store/record_codec.hpp"
#include "store/record_parts.hpp"

namespace anticrack::store::disk {

constexpr std::array mesh_states{MeshState::pending, MeshState::meshing, MeshState::factorizing,
                                 MeshState::ready,   MeshState::evicted, MeshState::failed};
constexpr std::array presets{mesh::Preset::graded, mesh::Preset::paper, mesh::Preset::uniform};
constexpr std::array shapes{mesh::Shape::polyline, mesh::Shape::arc, mesh::Shape::spline};
constexpr std::array kinds{mesh::Kind::glue, mesh::Kind::crack, mesh::Kind::inclusion,
                           mesh::Kind::delaminated};

static void append(const mesh::Point& point, google::protobuf::RepeatedField<double>& out) {
  out.Add(point[0]);
  out.Add(point[1]);
}

static mesh::Point point(const google::protobuf::RepeatedField<double>& in, int index) {
  return {in[2 * index], in[2 * index + 1]};
}

/// How many points or parts `xy` holds, `width` numbers each.
static int count(const google::protobuf::RepeatedField<double>& xy, int width) {
  if (xy.size() % width != 0) {
    throw damaged_record("a list of points is cut off");
  }
  return xy.size() / width;
}

static void write(const std::vector<mesh::Point>& points, Points& out) {
  for (const mesh::Point& at : points) {
    append(at, *out.mutable_xy());
  }
}

static std::vector<mesh::Point> read(const Points& in) {
  std::vector<mesh::Point> points;
  for (int i = 0, n = count(in.xy(), 2); i < n; ++i) {
    points.push_back(point(in.xy(), i));
  }
  return points;
}

static void write(const std::vector<mesh::Part>& parts, Parts& out) {
  for (const mesh::Part& part : parts) {
    append(part.from, *out.mutable_xy());
    append(part.to, *out.mutable_xy());
  }
}

static std::vector<mesh::Part> read(const Parts& in) {
  std::vector<mesh::Part> parts;
  for (int i = 0, n = count(in.xy(), 4); i < n; ++i) {
    parts.push_back({point(in.xy(), 2 * i), point(in.xy(), 2 * i + 1)});
  }
  return parts;
}

/// The one item of a list that was written from one.
template <class Item>
static Item single(const std::vector<Item>& items) {
  if (items.size() != 1) {
    throw damaged_record("there are " + std::to_string(items.size()) + " points where one is due");
  }
  return items.front();
}

using Tags = google::protobuf::RepeatedPtrField<TagName>;

static void write(const std::map<std::int32_t, std::string>& names, Tags& out) {
  for (const auto& [tag, name] : names) {
    TagName& item = *out.Add();
    item.set_tag(tag);
    item.set_name(name);
  }
}

static std::map<std::int32_t, std::string> read(const Tags& in) {
  std::map<std::int32_t, std::string> names;
  for (const TagName& item : in) {
    names[item.tag()] = item.name();
  }
  return names;
}

static void write(const mesh::MeshOptions& options, MeshOptions& out) {
  out.set_preset(number(presets, options.preset));
  out.set_size(options.size);
  out.set_tip_size(options.tip_size);
  out.set_grading(options.grading);
  write_all(options.align, *out.mutable_align());
  write(options.curve_groups, *out.mutable_curve_groups());
  write(options.surface_groups, *out.mutable_surface_groups());
  write(options.tension, *out.mutable_tension());
}

static mesh::MeshOptions read(const MeshOptions& in) {
  mesh::MeshOptions options;
  options.preset = choice(presets, in.preset());
  options.size = in.size();
  options.tip_size = in.tip_size();
  options.grading = in.grading();
  options.align = read_all(in.align());
  options.curve_groups = read(in.curve_groups());
  options.surface_groups = read(in.surface_groups());
  options.tension = read(in.tension());
  return options;
}

static void write(const mesh::InterfaceSpec& spec, InterfaceSpec& out) {
  out.set_name(spec.name);
  out.set_shape(number(shapes, spec.shape));
  write(spec.points, *out.mutable_points());
  out.set_closed(spec.closed);
}

static mesh::InterfaceSpec read(const InterfaceSpec& in) {
  return {in.name(), choice(shapes, in.shape()), read(in.points()), in.closed()};
}

static void write(const mesh::InclusionSpec& spec, InclusionSpec& out) {
  out.set_name(spec.name);
  write({spec.part}, *out.mutable_part());
  write(spec.delaminated, *out.mutable_delaminated());
}

static mesh::InclusionSpec read(const InclusionSpec& in) {
  return {in.name(), single(read(in.part())), read(in.delaminated())};
}

static void write(const mesh::CrackSpec& spec, CrackSpec& out) {
  out.set_name(spec.name);
  write({spec.part}, *out.mutable_part());
}

static mesh::CrackSpec read(const CrackSpec& in) {
  return {in.name(), single(read(in.part()))};
}

static void write(const mesh::RegionSpec& spec, RegionSpec& out) {
  out.set_name(spec.name);
  append(spec.at, *out.mutable_at()->mutable_xy());
  out.set_tension(spec.tension);
}

static mesh::RegionSpec read(const RegionSpec& in) {
  return {in.name(), single(read(in.at())), in.tension()};
}

static void write(const mesh::Geometry& geometry, Geometry& out) {
  write(geometry.boundary, *out.mutable_boundary());
  write_all(geometry.interfaces, *out.mutable_interfaces());
  write_all(geometry.inclusions, *out.mutable_inclusions());
  write_all(geometry.cracks, *out.mutable_cracks());
  write(geometry.neumann, *out.mutable_neumann());
  write_all(geometry.regions, *out.mutable_regions());
}

static mesh::Geometry read(const Geometry& in) {
  return {read(in.boundary()),   read_all(in.interfaces()), read_all(in.inclusions()),
          read_all(in.cracks()), read(in.neumann()),        read_all(in.regions())};
}

static void write(const store::SubdomainSummary& summary, SubdomainSummary& out) {
  out.set_name(summary.name);
  out.set_node_count(summary.node_count);
  out.set_triangle_count(summary.triangle_count);
  out.set_area(summary.area);
  out.set_tension(summary.tension);
  out.set_floating(summary.floating);
  out.set_minimum_angle(summary.minimum_angle);
  out.set_shortest_edge(summary.shortest_edge);
  out.set_longest_edge(summary.longest_edge);
}

static store::SubdomainSummary read(const SubdomainSummary& in) {
  return {in.name(),     in.node_count(),    in.triangle_count(), in.area(),        in.tension(),
          in.floating(), in.minimum_angle(), in.shortest_edge(),  in.longest_edge()};
}

static void write(const store::TipSummary& summary, TipSummary& out) {
  append(summary.at, *out.mutable_at()->mutable_xy());
  out.set_interface(summary.interface);
  out.set_smallest_edge(summary.smallest_edge);
}

static store::TipSummary read(const TipSummary& in) {
  return {single(read(in.at())), in.interface(), in.smallest_edge()};
}

static void write(const store::SegmentSummary& summary, SegmentSummary& out) {
  out.set_kind(number(kinds, summary.kind));
  out.set_inclusion(summary.inclusion);
  out.set_begin(summary.begin);
  out.set_end(summary.end);
  out.set_edge_count(summary.edge_count);
}

static store::SegmentSummary read(const SegmentSummary& in) {
  return {choice(kinds, in.kind()), in.inclusion(), in.begin(), in.end(), in.edge_count()};
}

static void write(const store::InterfaceSummary& summary, InterfaceSummary& out) {
  out.set_name(summary.name);
  out.set_length(summary.length);
  out.set_node_count(summary.node_count);
  write_all(summary.segments, *out.mutable_segments());
}

static store::InterfaceSummary read(const InterfaceSummary& in) {
  return {in.name(), in.length(), in.node_count(), read_all(in.segments())};
}

static void write(const MeshDefinition& definition, MeshRecord& out) {
  if (const auto* upload = std::get_if<UploadRef>(&definition)) {
    out.set_upload(upload->sha256);
    write(upload->options, *out.mutable_options());
  } else {
    const auto& source = std::get<GeometrySource>(definition);
    write(source.geometry, *out.mutable_geometry());
    write(source.options, *out.mutable_options());
  }
}

static MeshDefinition definition_of(const MeshRecord& in) {
  switch (in.definition_case()) {
    case MeshRecord::kGeometry:
      return GeometrySource{read(in.geometry()), read(in.options())};
    case MeshRecord::kUpload:
      return UploadRef{in.upload(), read(in.options())};
    case MeshRecord::DEFINITION_NOT_SET:
      break;
  }
  throw damaged_record("a mesh without a definition");
}

}  // namespace anticrack::store::disk

namespace anticrack::store {

std::string encode(const MeshRecord& record) {
  disk::MeshRecord out;
  out.set_id(record.id);
  out.set_owner(record.owner);
  out.set_title(record.title);
  disk::write(record.definition, out);
  out.set_state(disk::number(disk::mesh_states, record.state));
  if (record.error) {
    disk::write(*record.error, *out.mutable_error());
  }
  out.set_created_ns(disk::to_disk(record.created));
  out.set_sha256(record.sha256);
  out.set_node_count(record.node_count);
  out.set_triangle_count(record.triangle_count);
  disk::write_all(record.subdomains, *out.mutable_subdomains());
  disk::write_all(record.interfaces, *out.mutable_interfaces());
  disk::write(record.inclusions, *out.mutable_inclusions());
  disk::write(record.warnings, *out.mutable_warnings());
  out.set_minimum_angle(record.minimum_angle);
  out.set_bisection_bound(record.bisection_bound);
  disk::write_all(record.tips, *out.mutable_tips());
  out.set_dirichlet_length(record.dirichlet_length);
  out.set_neumann_length(record.neumann_length);
  out.set_mesh_seconds(record.mesh_seconds);
  out.set_operator_bytes(record.operator_bytes);
  out.set_theta_star(record.theta_star);
  out.set_factorize_seconds(record.factorize_seconds);
  return disk::serialized(out);
}

MeshRecord decode_mesh_record(std::string_view bytes) {
  disk::MeshRecord in;
  disk::parse(bytes, in);
  MeshRecord record;
  record.id = in.id();
  record.owner = in.owner();
  record.title = in.title();
  record.definition = disk::definition_of(in);
  record.state = disk::choice(disk::mesh_states, in.state());
  if (in.has_error()) {
    record.error = disk::read(in.error());
  }
  record.created = disk::time_of(in.created_ns());
  record.sha256 = in.sha256();
  record.node_count = in.node_count();
  record.triangle_count = in.triangle_count();
  record.subdomains = disk::read_all(in.subdomains());
  record.interfaces = disk::read_all(in.interfaces());
  record.inclusions = disk::read(in.inclusions());
  record.warnings = disk::read(in.warnings());
  record.minimum_angle = in.minimum_angle();
  record.bisection_bound = in.bisection_bound();
  record.tips = disk::read_all(in.tips());
  record.dirichlet_length = in.dirichlet_length();
  record.neumann_length = in.neumann_length();
  record.mesh_seconds = in.mesh_seconds();
  record.operator_bytes = in.operator_bytes();
  record.theta_star = in.theta_star();
  record.factorize_seconds = in.factorize_seconds();
  return record;
}

}  // namespace anticrack::store
