// SPDX-License-Identifier: GPL-3.0-or-later
//
// From the definition of a mesh to its triangulation and summary.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "mesh/mesh.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

struct Triangulation {
  std::shared_ptr<const mesh::Mesh> mesh;
  records::MeshRecord record;  ///< with the summary; not in the store yet
};

/// Path of an upload of `owner`. Throws errors::Error (not_found, at "upload").
std::string require_upload(const store::Store& store, const records::UploadRef& upload,
                           const std::string& owner);

/// Checks a definition without the mesher and returns a rough number of triangles. Throws as
/// mesh::plan, mesh::check_for_upload, require_upload and mesher::require_msh do.
std::size_t check_definition(const records::MeshDefinition& definition, const std::string& owner,
                             const CatalogueOptions& options, const store::Store& store);
/// The same for a record; 0 if its definition is wrong.
std::size_t expected_triangles(const records::MeshRecord& record, const CatalogueOptions& options,
                               const store::Store& store);

/// Fills in what a record says of its triangulation, which took since `start` to make. O(m log m).
void meshed(const mesh::Mesh& mesh, std::chrono::steady_clock::time_point start,
            records::MeshRecord& record);

/// Receives how far the mesher is, about every second.
using ProgressListener = std::function<void(const records::MeshProgress&)>;

/// Runs the helper: seconds to minutes. Throws as mesher::run, mesh::plan and require_upload do.
Triangulation triangulate(records::MeshRecord record, const CatalogueOptions& options,
                          const store::Store& store, const std::stop_token& stop,
                          const ProgressListener& progress);

/// The triangulation of another mesh with the same definition; none if that has gone. O(m).
std::optional<Triangulation> copy_of(const std::string& twin, records::MeshRecord record,
                                     const store::Store& store);

}  // namespace anticrack::meshes
