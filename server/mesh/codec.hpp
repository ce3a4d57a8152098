// SPDX-License-Identifier: GPL-3.0-or-later
//
// What travels between the server and the helper process, and what a mesh is stored as: bytes,
// little-endian, each array with its length before it. Reading checks every length against what is
// there before it allocates.
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

/// Canonical: equal meshes give equal bytes (warnings are not part of it), so a hash of them
/// identifies the mesh.
Bytes encode(const Mesh& mesh);
/// Throws errors::Error (mesh_invalid) where the bytes are not those of a mesh.
Mesh decode_mesh(std::span<const std::byte> bytes);

/// Mesh this plan, then grade.
struct GenerateRequest {
  Plan plan;
  std::size_t max_triangles = 0;
};
ANTICRACK_FIELDS(GenerateRequest, plan, max_triangles)
/// Read this .msh, then grade or refine as the options say; the file begins with $MeshFormat.
struct ImportRequest {
  std::string path;
  MeshOptions options;
  std::size_t max_triangles = 0;
};
ANTICRACK_FIELDS(ImportRequest, path, options, max_triangles)
using MesherRequest = std::variant<GenerateRequest, ImportRequest>;
using MesherReply = std::variant<Mesh, errors::Error>;

/// What goes to the helper; decode_request throws errors::Error (mesh_invalid) for what encode does
/// not make.
Bytes encode(const MesherRequest& request);
MesherRequest decode_request(std::span<const std::byte> bytes);
/// The reply carries the mesh's warnings and its bisection bound as well.
Bytes encode(const MesherReply& reply);
MesherReply decode_reply(std::span<const std::byte> bytes);

}  // namespace anticrack::mesh
