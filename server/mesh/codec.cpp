// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/codec.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>

#include "mesh/codec_bytes.hpp"

namespace anticrack::mesh {
namespace {

// The first eight bytes name the kind of message and the version of the format.
/// Of a mesh that is followed by so many of the fields that `later` names, in their order.
constexpr std::array<std::string_view, 5> mesh_tags{"ACMESH2\n", "ACMESH3\n", "ACMESH4\n",
                                                    "ACMESH5\n", "ACMESH6\n"};
constexpr std::string_view request_tag = "ACMREQ6\n";
constexpr std::string_view reply_tag = "ACMREP5\n";

constexpr auto last_reason = static_cast<std::int32_t>(errors::Reason::internal);

/// Whether any inclusion has a motion other than the default.
bool moves(const Mesh& mesh) {
  return std::ranges::any_of(mesh.motions, [](const Motion& m) { return m != Motion(); });
}

/// Fields that are not part of the hash of a mesh. Motions, laws, chords and boundary parts are
/// among them, as they were added later: a mesh without them keeps its hash. The bends leave the
/// mesher only as chords.
bool is_beside(std::string_view field) {
  return field == "warnings" || field == "bisection_bound" || field == "motions" ||
         field == "tension_laws" || field == "bends" || field == "bent" || field == "chords" ||
         field == "boundary_parts";
}

void put(Writer& out, const Mesh& mesh) {
  fields::for_each(mesh, [&](const auto& field) {
    if (field.name == "tension" && mesh.tension.empty())
      out.value(std::vector<double>(mesh.subdomains.size(), 1.0));
    else if (!is_beside(field.name))
      out.value(field.value);
  });
}

/// About the size of an encoded mesh.
std::size_t bytes_of(const Mesh& mesh) {
  constexpr std::size_t lines = 64;  // for interfaces, the boundary and names
  return mesh.xy.size() * sizeof(double) +
         (mesh.triangles.size() + mesh.subdomain.size()) * sizeof(std::int32_t) +
         mesh.dirichlet.size() * lines + lines * lines;
}

/// Calls visit() with the first `count` of the fields that meshes got later.
template <class AnyMesh, class Visit>
void later(AnyMesh& mesh, std::size_t count, const Visit& visit) {
  if (count > 0) visit(mesh.motions);
  if (count > 1) visit(mesh.tension_laws);
  if (count > 2) visit(mesh.chords);
  if (count > 3) visit(mesh.boundary_parts);
}

/// How many of these a mesh needs.
std::size_t later_of(const Mesh& mesh) {
  return !mesh.boundary_parts.empty() ? 4
         : !mesh.chords.empty()       ? 3
         : !mesh.tension_laws.empty() ? 2
         : moves(mesh)                ? 1
                                      : 0;
}

Mesh get_mesh(Reader& in) {
  Mesh mesh;
  fields::for_each(mesh, [&](const auto& field) {
    if (!is_beside(field.name)) in.read(field.value);
  });
  return mesh;
}

/// Refuses an index outside an array of `size` items.
void check_index(int index, std::size_t size, const char* what) {
  if (index >= 0 && static_cast<std::size_t>(index) < size) return;
  Reader::fail(fmt::format("{} has the number {} of {}", what, index, size));
}

/// The mesher uses these indices unchecked.
void check_indices(const Plan& plan) {
  for (const PlannedCurve& curve : plan.curves) {
    check_index(curve.a, plan.points.size(), "a point");
    check_index(curve.b, plan.points.size(), "a point");
    for (const int face : {curve.left, curve.right})
      if (face != -1) check_index(face, plan.faces.size(), "a face");
    if (curve.inclusion != -1) check_index(curve.inclusion, plan.inclusions.size(), "an inclusion");
    if (curve.bend != -1) check_index(curve.bend, plan.bends.size(), "a bend");
    if (curve.side != -1) check_index(curve.side, plan.sides.size(), "a side");
  }
  const auto check_curves = [&](const std::vector<int>& curves) {
    for (const int curve : curves) check_index(curve, plan.curves.size(), "a curve");
  };
  const auto check_loop = [&](const std::vector<int>& loop) {
    const auto n = static_cast<std::int64_t>(plan.curves.size());
    for (const int signed_curve : loop) {
      if (signed_curve == 0 || std::abs(std::int64_t{signed_curve}) > n) {
        Reader::fail(fmt::format("a loop names curve {} of {}", signed_curve, n));
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

/// Writes an error; its fields are sent as paths, as their description is the message
/// (errors::Error::at).
void put(Writer& out, const errors::Error& error) {
  out.number(static_cast<std::int32_t>(error.reason()));
  out.text(error.what());
  out.count(error.fields().size());
  for (const errors::FieldViolation& violation : error.fields()) out.text(violation.field);
  out.value(error.metadata());
  out.number(static_cast<std::int64_t>(error.retry_delay().count()));
}

errors::Error get_error(Reader& in) {
  const auto reason = static_cast<errors::Reason>(in.choice(0, last_reason, "an error's reason"));
  errors::Error error(reason, in.text());
  std::vector<std::string> fields;
  in.read(fields);
  for (std::string& field : fields) error.at(std::move(field));
  std::map<std::string, std::string> metadata;
  in.read(metadata);
  for (const auto& [key, value] : metadata) error.with(key, value);
  error.retry_after(std::chrono::milliseconds(in.number<std::int64_t>()));
  return error;
}

}  // namespace

static Choices choices_of(Kind) {
  return {1, static_cast<std::int32_t>(Kind::free), "an edge's kind"};
}
static Choices choices_of(Role) {
  return {0, static_cast<std::int32_t>(Role::align), "a curve's role"};
}
static Choices choices_of(Preset) {
  return {0, static_cast<std::int32_t>(Preset::coarse), "the preset"};
}

Bytes encode(const Mesh& mesh) {
  const std::size_t count = later_of(mesh);
  Writer out(mesh_tags[count], bytes_of(mesh));
  put(out, mesh);
  later(mesh, count, [&]<class Field>(const Field& field) {
    if constexpr (std::is_same_v<Field, std::vector<Motion>>)
      out.value(moves(mesh) ? field : Field());
    else
      out.value(field);
  });
  return out.take();
}

Mesh decode_mesh(std::span<const std::byte> bytes) {
  std::size_t count = mesh_tags.size() - 1;
  while (count > 0 && !Reader::begins(bytes, mesh_tags[count])) --count;
  Reader in(bytes, mesh_tags[count]);
  Mesh mesh = get_mesh(in);
  later(mesh, count, [&](auto& field) { in.read(field); });
  in.end();
  return mesh;
}

Bytes encode(const MesherRequest& request) {
  Writer out(request_tag);
  out.number(static_cast<std::int32_t>(request.index()));
  std::visit([&out](const auto& held) { out.value(held); }, request);
  return out.take();
}

MesherRequest decode_request(std::span<const std::byte> bytes) {
  Reader in(bytes, request_tag);
  MesherRequest request;
  if (in.choice(0, 1, "the request") == 0) {
    in.read(request.emplace<GenerateRequest>());
    check_indices(std::get<GenerateRequest>(request).plan);
  } else {
    in.read(request.emplace<ImportRequest>());
  }
  in.end();
  return request;
}

Bytes encode(const MesherReply& reply) {
  Writer out(reply_tag);
  out.number(static_cast<std::int32_t>(reply.index()));
  if (const auto* mesh = std::get_if<Mesh>(&reply)) {
    put(out, *mesh);
    later(*mesh, mesh_tags.size() - 1, [&](const auto& field) { out.value(field); });
    out.value(mesh->warnings);
    out.value(mesh->bisection_bound);
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
  later(mesh, mesh_tags.size() - 1, [&](auto& field) { in.read(field); });
  in.read(mesh.warnings);
  in.read(mesh.bisection_bound);
  in.end();
  return mesh;
}

}  // namespace anticrack::mesh
