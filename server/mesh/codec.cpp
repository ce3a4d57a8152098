// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/codec.hpp"

#include <cstdint>
#include <cstdlib>
#include <map>
#include <string_view>
#include <utility>

#include "mesh/codec_bytes.hpp"

namespace anticrack::mesh {
namespace {

// The first eight bytes say what follows and in which version of the format.
constexpr std::string_view mesh_tag = "ACMESH2\n";
constexpr std::string_view request_tag = "ACMREQ2\n";
constexpr std::string_view reply_tag = "ACMREP2\n";

constexpr auto last_kind = static_cast<std::int32_t>(Kind::delaminated);
constexpr auto last_role = static_cast<std::int32_t>(Role::align);
constexpr auto last_preset = static_cast<std::int32_t>(Preset::uniform);
constexpr auto last_reason = static_cast<std::int32_t>(errors::Reason::internal);

void put(Writer& out, const Mesh& mesh) {
  out.numbers(mesh.xy);
  out.numbers(mesh.triangles);
  out.numbers(mesh.subdomain);
  out.texts(mesh.subdomains);
  // no tension at all means 1 everywhere
  out.numbers(mesh.tension.empty() ? std::vector<double>(mesh.subdomains.size(), 1.0)
                                   : mesh.tension);
  out.texts(mesh.inclusions);
  out.list(mesh.interfaces, [&](const Interface& interface) {
    out.text(interface.name);
    out.numbers(interface.nodes);
    out.list(interface.kind, [&](Kind kind) { out.number(static_cast<std::int32_t>(kind)); });
    out.numbers(interface.inclusion);
  });
  out.list(mesh.dirichlet, [&](const std::array<std::int32_t, 2>& edge) {
    out.number(edge[0]);
    out.number(edge[1]);
  });
}

Kind get_kind(Reader& in) {
  return static_cast<Kind>(in.choice(1, last_kind, "an edge's kind"));
}

Mesh get_mesh(Reader& in) {
  Mesh mesh;
  mesh.xy = in.numbers<double>();
  mesh.triangles = in.numbers<std::int32_t>();
  mesh.subdomain = in.numbers<std::int32_t>();
  mesh.subdomains = in.texts();
  mesh.tension = in.numbers<double>();
  mesh.inclusions = in.texts();
  mesh.interfaces = in.list(32, [&] {
    Interface interface;
    interface.name = in.text();
    interface.nodes = in.numbers<std::int32_t>();
    interface.kind = in.list(4, [&] { return get_kind(in); });
    interface.inclusion = in.numbers<std::int32_t>();
    return interface;
  });
  mesh.dirichlet = in.list(8, [&] {
    const auto a = in.number<std::int32_t>();
    const auto b = in.number<std::int32_t>();
    return std::array<std::int32_t, 2>{a, b};
  });
  return mesh;
}

void put(Writer& out, const Point& point) {
  out.number(point[0]);
  out.number(point[1]);
}

Point get_point(Reader& in) {
  const auto x = in.number<double>();
  const auto y = in.number<double>();
  return {x, y};
}

void put(Writer& out, const PlannedCurve& curve) {
  out.number(static_cast<std::int32_t>(curve.a));
  out.number(static_cast<std::int32_t>(curve.b));
  out.number(static_cast<std::int32_t>(curve.intervals));
  out.number(static_cast<std::int32_t>(curve.role));
  out.number(static_cast<std::int32_t>(curve.left));
  out.number(static_cast<std::int32_t>(curve.right));
  out.number(static_cast<std::int32_t>(curve.kind));
  out.number(static_cast<std::int32_t>(curve.inclusion));
}

PlannedCurve get_curve(Reader& in) {
  PlannedCurve curve;
  curve.a = in.number<std::int32_t>();
  curve.b = in.number<std::int32_t>();
  curve.intervals = in.number<std::int32_t>();
  curve.role = static_cast<Role>(in.choice(0, last_role, "a curve's role"));
  curve.left = in.number<std::int32_t>();
  curve.right = in.number<std::int32_t>();
  curve.kind = get_kind(in);
  curve.inclusion = in.number<std::int32_t>();
  return curve;
}

void put(Writer& out, const PlannedFace& face) {
  out.text(face.name);
  out.number(face.tension);
  out.numbers(face.outer);
  out.list(face.holes, [&](const std::vector<int>& hole) { out.numbers(hole); });
  out.numbers(face.embedded);
}

PlannedFace get_face(Reader& in) {
  PlannedFace face;
  face.name = in.text();
  face.tension = in.number<double>();
  face.outer = in.numbers<int>();
  face.holes = in.list(8, [&] { return in.numbers<int>(); });
  face.embedded = in.numbers<int>();
  return face;
}

void put(Writer& out, const Plan& plan) {
  out.list(plan.points, [&](const Point& point) { put(out, point); });
  out.list(plan.curves, [&](const PlannedCurve& curve) { put(out, curve); });
  out.list(plan.interfaces, [&](const PlannedInterface& interface) {
    out.text(interface.name);
    out.numbers(interface.curves);
  });
  out.list(plan.faces, [&](const PlannedFace& face) { put(out, face); });
  out.texts(plan.inclusions);
  out.number(plan.growth);
  out.number(plan.grading.h0);
  out.number(plan.grading.m);
  out.number(plan.grading.tip_size);
}

/// A place in an array of `size` items.
void check_index(int index, std::size_t size, const char* what) {
  if (index >= 0 && static_cast<std::size_t>(index) < size) return;
  Reader::fail(std::string(what) + " has the number " + std::to_string(index) + " of " +
               std::to_string(size));
}

/// The mesher walks these numbers without looking.
void check_indices(const Plan& plan) {
  for (const PlannedCurve& curve : plan.curves) {
    check_index(curve.a, plan.points.size(), "a point");
    check_index(curve.b, plan.points.size(), "a point");
    for (const int face : {curve.left, curve.right}) {
      if (face != -1) check_index(face, plan.faces.size(), "a face");
    }
    if (curve.inclusion != -1) check_index(curve.inclusion, plan.inclusions.size(), "an inclusion");
  }
  const auto check_curves = [&](const std::vector<int>& curves) {
    for (const int curve : curves) check_index(curve, plan.curves.size(), "a curve");
  };
  const auto check_loop = [&](const std::vector<int>& loop) {
    const auto n = static_cast<std::int64_t>(plan.curves.size());
    for (const int signed_curve : loop) {
      if (signed_curve == 0 || std::abs(std::int64_t{signed_curve}) > n) {
        Reader::fail("a loop names curve " + std::to_string(signed_curve) + " of " +
                     std::to_string(n));
      }
    }
  };
  for (const PlannedInterface& interface : plan.interfaces) check_curves(interface.curves);
  for (const PlannedFace& face : plan.faces) {
    check_loop(face.outer);
    for (const std::vector<int>& hole : face.holes) check_loop(hole);
    check_curves(face.embedded);
  }
}

Plan get_plan(Reader& in) {
  Plan plan;
  plan.points = in.list(16, [&] { return get_point(in); });
  plan.curves = in.list(32, [&] { return get_curve(in); });
  plan.interfaces = in.list(16, [&] {
    PlannedInterface interface;
    interface.name = in.text();
    interface.curves = in.numbers<int>();
    return interface;
  });
  plan.faces = in.list(40, [&] { return get_face(in); });
  plan.inclusions = in.texts();
  plan.growth = in.number<double>();
  plan.grading.h0 = in.number<double>();
  plan.grading.m = in.number<double>();
  plan.grading.tip_size = in.number<double>();
  check_indices(plan);
  return plan;
}

template <class Map, class Write>
void put_map(Writer& out, const Map& map, Write write) {
  out.list(map, [&](const auto& entry) { write(entry.first, entry.second); });
}

void put(Writer& out, const MeshOptions& options) {
  out.number(static_cast<std::int32_t>(options.preset));
  out.number(options.size);
  out.number(options.tip_size);
  out.number(options.grading);
  out.list(options.align, [&](const std::vector<Point>& line) {
    out.list(line, [&](const Point& point) { put(out, point); });
  });
  const auto group = [&](std::int32_t tag, const std::string& name) {
    out.number(tag);
    out.text(name);
  };
  put_map(out, options.curve_groups, group);
  put_map(out, options.surface_groups, group);
  put_map(out, options.tension, [&](const std::string& name, double tension) {
    out.text(name);
    out.number(tension);
  });
}

std::map<std::int32_t, std::string> get_groups(Reader& in) {
  std::map<std::int32_t, std::string> groups;
  const std::size_t n = in.count(12);
  for (std::size_t i = 0; i < n; ++i) {
    const auto tag = in.number<std::int32_t>();
    groups[tag] = in.text();
  }
  return groups;
}

MeshOptions get_options(Reader& in) {
  MeshOptions options;
  options.preset = static_cast<Preset>(in.choice(0, last_preset, "the preset"));
  options.size = in.number<double>();
  options.tip_size = in.number<double>();
  options.grading = in.number<double>();
  options.align = in.list(8, [&] { return in.list(16, [&] { return get_point(in); }); });
  options.curve_groups = get_groups(in);
  options.surface_groups = get_groups(in);
  const std::size_t n = in.count(16);
  for (std::size_t i = 0; i < n; ++i) {
    std::string name = in.text();
    options.tension[std::move(name)] = in.number<double>();
  }
  return options;
}

/// The description of every field violation is the message itself (errors::Error::at), so the
/// paths are enough.
void put(Writer& out, const errors::Error& error) {
  out.number(static_cast<std::int32_t>(error.reason()));
  out.text(error.what());
  out.list(error.fields(), [&](const errors::FieldViolation& field) { out.text(field.field); });
  out.list(error.metadata(), [&](const auto& entry) {
    out.text(entry.first);
    out.text(entry.second);
  });
  out.number(static_cast<std::int64_t>(error.retry_delay().count()));
}

errors::Error get_error(Reader& in) {
  const auto reason = static_cast<errors::Reason>(in.choice(0, last_reason, "an error's reason"));
  errors::Error error(reason, in.text());
  for (std::string& field : in.texts()) error.at(std::move(field));
  const std::size_t entries = in.count(16);
  for (std::size_t i = 0; i < entries; ++i) {
    std::string key = in.text();
    error.with(std::move(key), in.text());
  }
  error.retry_after(std::chrono::milliseconds(in.number<std::int64_t>()));
  return error;
}

}  // namespace

Bytes encode(const Mesh& mesh) {
  Writer out(mesh_tag);
  put(out, mesh);
  return out.take();
}

Mesh decode_mesh(std::span<const std::byte> bytes) {
  Reader in(bytes, mesh_tag);
  Mesh mesh = get_mesh(in);
  in.end();
  return mesh;
}

Bytes encode(const MesherRequest& request) {
  Writer out(request_tag);
  out.number(static_cast<std::int32_t>(request.index()));
  if (const auto* generate = std::get_if<GenerateRequest>(&request)) {
    put(out, generate->plan);
    out.count(generate->max_triangles);
  } else {
    const auto& import = std::get<ImportRequest>(request);
    out.text(import.path);
    put(out, import.options);
    out.count(import.max_triangles);
  }
  return out.take();
}

MesherRequest decode_request(std::span<const std::byte> bytes) {
  Reader in(bytes, request_tag);
  MesherRequest request;
  if (in.choice(0, 1, "the request") == 0) {
    GenerateRequest generate;
    generate.plan = get_plan(in);
    generate.max_triangles = in.number<std::uint64_t>();
    request = std::move(generate);
  } else {
    ImportRequest import;
    import.path = in.text();
    import.options = get_options(in);
    import.max_triangles = in.number<std::uint64_t>();
    request = std::move(import);
  }
  in.end();
  return request;
}

Bytes encode(const MesherReply& reply) {
  Writer out(reply_tag);
  out.number(static_cast<std::int32_t>(reply.index()));
  if (const auto* mesh = std::get_if<Mesh>(&reply)) {
    put(out, *mesh);
    out.texts(mesh->warnings);
    out.number(mesh->bisection_bound);
  } else {
    put(out, std::get<errors::Error>(reply));
  }
  return out.take();
}

MesherReply decode_reply(std::span<const std::byte> bytes) {
  Reader in(bytes, reply_tag);
  if (in.choice(0, 1, "the reply") == 1) {
    errors::Error error = get_error(in);
    in.end();
    return error;
  }
  Mesh mesh = get_mesh(in);
  mesh.warnings = in.texts();
  mesh.bisection_bound = in.number<double>();
  in.end();
  return mesh;
}

}  // namespace anticrack::mesh
