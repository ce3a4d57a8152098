// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes the triangulation and the summary of a mesh from its definition.
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
  records::MeshRecord record;  ///< not in the store yet
};

/// Checks a definition without the mesher and returns a rough number of triangles. Throws as
/// mesh::plan, mesh::check_for_upload and mesher::require_msh do, and not_found at "upload".
std::size_t check_definition(const records::MeshDefinition& definition, const std::string& owner,
                             const CatalogueOptions& options, const store::Store& store);
/// The same for a record; 0 if its definition is wrong.
std::size_t expected_triangles(const records::MeshRecord& record, const CatalogueOptions& options,
                               const store::Store& store);

/// Fills in the record's data of the triangulation, whose making began at `start`, but for its
/// summary. O(m).
void meshed(const mesh::Mesh& mesh, std::chrono::steady_clock::time_point start,
            records::MeshRecord& record);

/// Called about every second with the progress of the mesher.
using ProgressListener = std::function<void(const records::MeshProgress&)>;

/// Runs the helper: seconds to minutes. The record has no summary yet. Throws as mesher::run,
/// mesh::plan do, and not_found at "upload".
Triangulation triangulate(records::MeshRecord record, const CatalogueOptions& options,
                          const store::Store& store, const std::stop_token& stop,
                          const ProgressListener& progress);

/// The triangulation of another mesh with the same definition; none if it was erased. O(m).
std::optional<Triangulation> copy_of(const std::string& twin, records::MeshRecord record,
                                     const store::Store& store);

}  // namespace anticrack::meshes
