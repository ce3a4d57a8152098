// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/triangulation.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>
#include <variant>

#include "errors/placed.hpp"
#include "mesh/codec.hpp"
#include "meshes/summary.hpp"
#include "meshes/tension_laws.hpp"
#include "stop/stop.hpp"
#include "store/files.hpp"

namespace anticrack::meshes {

namespace {

mesh::MesherRequest request_for(const records::MeshRecord& record, const CatalogueOptions& options,
                                const store::Store& store) {
  if (const auto* source = std::get_if<records::GeometrySource>(&record.definition)) {
    return mesh::GenerateRequest{
        mesh::plan(source->geometry, source->options, options.max_triangles),
        options.max_triangles};
  }
  if (std::holds_alternative<records::Refinement>(record.definition)) {
    throw errors::Error(
        errors::Reason::storage,
        "the triangulation of meshes/{}, which a job made, is gone: run the job again", record.id);
  }
  const auto& upload = std::get<records::UploadRef>(record.definition);
  std::string path = errors::at(
      "upload", [&] { return store::require_upload(store, upload.sha256, record.owner); });
  try {
    store::require_intact_upload(path, upload.sha256);
  } catch (const errors::Error& damaged) {  // unlike an error of the disk, this is for good
    throw errors::Error(errors::Reason::not_found, damaged.what()).at("upload");
  }
  return mesh::ImportRequest{std::move(path), upload.options, options.max_triangles};
}

/// Roughly how many triangles the mesher makes; 0 if bisection decides.
std::uint64_t expected_of(const mesh::MesherRequest& request) {
  const auto* generate = std::get_if<mesh::GenerateRequest>(&request);
  return generate == nullptr || generate->plan.grading.h0 > 0 ? 0 : generate->plan.triangles;
}

}  // namespace

std::size_t check_definition(const records::MeshDefinition& definition, const std::string& owner,
                             const CatalogueOptions& options, const store::Store& store) {
  check_laws(definition, options.max_expression_bytes);
  if (const auto* source = std::get_if<records::GeometrySource>(&definition))
    return mesh::plan(source->geometry, source->options, options.max_triangles).triangles;
  if (std::holds_alternative<records::Refinement>(definition)) return 0;
  constexpr std::size_t bytes_a_triangle = 60;  // of a .msh file, nodes included
  const auto& upload = std::get<records::UploadRef>(definition);
  mesh::check_for_upload(upload.options);
  const std::string path =
      errors::at("upload", [&] { return store::require_upload(store, upload.sha256, owner); });
  mesher::require_msh(path);
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  return unknown ? 0 : bytes / bytes_a_triangle;
}

std::size_t expected_triangles(const records::MeshRecord& record, const CatalogueOptions& options,
                               const store::Store& store) {
  try {
    return check_definition(record.definition, record.owner, options, store);
  } catch (const errors::Error&) {
    return 0;  // the run will report the error
  }
}

void meshed(const mesh::Mesh& mesh, std::chrono::steady_clock::time_point start,
            records::MeshRecord& record) {
  record.mesh_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const mesh::Bytes encoded = mesh::encode(mesh);
  record.sha256 = store::sha256_of(encoded);
  record.state = records::MeshState::evicted;
}

Triangulation triangulate(records::MeshRecord record, const CatalogueOptions& options,
                          const store::Store& store, const std::stop_token& stop,
                          const ProgressListener& progress) {
  const auto start = std::chrono::steady_clock::now();
  const stop::Scope scope(stop);
  const mesh::MesherRequest request = request_for(record, options, store);
  const std::uint64_t expected = expected_of(request);
  auto mesh = std::make_shared<const mesh::Mesh>(
      mesher::run(options.helper, request, stop, [&](const mesher::Progress& now) {
        progress({now.doing, now.triangles, now.triangles < expected ? expected : 0});
      }));
  meshed(*mesh, start, record);
  return {std::move(mesh), std::move(record)};
}

std::optional<Triangulation> copy_of(const std::string& twin, records::MeshRecord record,
                                     const store::Store& store) {
  std::optional<records::MeshRecord> copy = store.mesh(twin);
  if (!copy || copy->sha256.empty()) return std::nullopt;
  std::shared_ptr<const mesh::Mesh> mesh = store.triangulation(copy->sha256);
  if (!mesh) return std::nullopt;
  copy->id = std::move(record.id);
  copy->owner = std::move(record.owner);
  copy->title = std::move(record.title);
  copy->created = record.created;
  copy->state = records::MeshState::evicted;
  copy->error.reset();
  return Triangulation{std::move(mesh), std::move(*copy)};
}

}  // namespace anticrack::meshes
