// SPDX-License-Identifier: GPL-3.0-or-later
//
// Messages between the server and the helper process, and the stored form of a mesh: little-endian
// bytes, each array after its length, which is checked before memory is allocated.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "errors/errors.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::mesh {

using Bytes = std::vector<std::byte>;

/// Canonical: equal meshes (apart from their warnings) give equal bytes, whose hash identifies
/// them.
Bytes encode(const Mesh& mesh);
/// Throws errors::Error (mesh_invalid) for malformed bytes.
Mesh decode_mesh(std::span<const std::byte> bytes);

/// Asks the helper to mesh this plan, then to grade the mesh.
struct GenerateRequest {
  Plan plan;
  std::size_t max_triangles = 0;
};
ANTICRACK_FIELDS(GenerateRequest, plan, max_triangles)
/// Asks the helper to read this .msh file, which begins with $MeshFormat, then to grade or refine
/// the mesh as the options say.
struct ImportRequest {
  std::string path;
  MeshOptions options;
  std::size_t max_triangles = 0;
};
ANTICRACK_FIELDS(ImportRequest, path, options, max_triangles)
using MesherRequest = std::variant<GenerateRequest, ImportRequest>;
using MesherReply = std::variant<Mesh, errors::Error>;

/// Requests to the helper. Decoding throws errors::Error (mesh_invalid) for malformed bytes.
Bytes encode(const MesherRequest& request);
MesherRequest decode_request(std::span<const std::byte> bytes);
/// Replies carry the mesh's warnings and bisection bound as well.
Bytes encode(const MesherReply& reply);
MesherReply decode_reply(std::span<const std::byte> bytes);

}  // namespace anticrack::mesh
