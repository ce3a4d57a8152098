// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/mesh_index.hpp"

#include <algorithm>

#include "meshes/identity.hpp"
#include "meshes/size_class.hpp"

namespace anticrack::meshes {

namespace {

using records::MeshRecord;
using records::MeshState;

MeshState state_of(const LiveMesh& mesh, const MeshRecord& record, bool in_memory) {
  if (record.state == MeshState::failed) return MeshState::failed;
  if (record.sha256.empty())
    return mesh.run ? std::min(mesh.run->phase, MeshState::meshing) : MeshState::pending;
  if (mesh.run && !mesh.run->visible) return MeshState::factorizing;
  return in_memory && mesh.operators.bytes > 0 ? MeshState::ready : MeshState::evicted;
}

}  // namespace

MeshRecord seen(const LiveMesh& mesh, MeshRecord record, bool in_memory) {
  record.state = state_of(mesh, record, in_memory);
  if (record.state == MeshState::meshing && mesh.run) record.progress = mesh.run->progress;
  if (mesh.operators.bytes > 0) {
    record.operator_bytes = mesh.operators.bytes;
    record.factorize_seconds = mesh.operators.seconds;
  }
  return record;
}

LiveMesh& MeshIndex::add(const MeshRecord& record) {
  LiveMesh& mesh = _meshes[record.id];
  mesh.stage = record.state == MeshState::failed ? Stage::failed
               : record.sha256.empty()           ? Stage::pending
                                                 : Stage::meshed;
  mesh.definition = identity(record.definition);
  mesh.owner = record.owner;
  mesh.sha256 = record.sha256;
  mesh.error = record.error;
  mesh.for_job = record.for_job;
  mesh.operators = {record.operator_bytes, record.factorize_seconds};
  mesh.size_class = size_class(record.triangle_count);
  return mesh;
}

LiveMesh* MeshIndex::find(const std::string& id) {
  const auto found = _meshes.find(id);
  return found == _meshes.end() ? nullptr : &found->second;
}

LiveMesh& MeshIndex::known(const std::string& id) {
  LiveMesh* mesh = find(id);
  if (mesh == nullptr || mesh->stage == Stage::absent) {
    throw errors::Error(errors::Reason::not_found, "there is no meshes/{}: create it first", id);
  }
  return *mesh;
}

std::vector<std::pair<std::string, std::string>> MeshIndex::measured() const {
  std::vector<std::pair<std::string, std::string>> found;
  for (const auto& [id, mesh] : _meshes)
    if (mesh.stage == Stage::meshed && mesh.operators.bytes > 0)
      found.emplace_back(id, mesh.sha256);
  return found;
}

int MeshIndex::pending() const {
  return static_cast<int>(std::count_if(_meshes.begin(), _meshes.end(), [](const auto& item) {
    return item.second.stage == Stage::pending && item.second.run;
  }));
}

std::string MeshIndex::twin(const std::string& id) const {
  const std::string& definition = _meshes.at(id).definition;
  const auto twin = std::find_if(_meshes.begin(), _meshes.end(), [&](const auto& item) {
    return item.second.definition == definition && item.first != id &&
           item.second.stage == Stage::meshed;
  });
  return twin == _meshes.end() ? std::string() : twin->first;
}

bool MeshIndex::shared(const std::string& id) const {
  const std::string& sha256 = _meshes.at(id).sha256;
  return std::any_of(_meshes.begin(), _meshes.end(), [&](const auto& item) {
    return item.second.sha256 == sha256 && item.first != id;
  });
}

}  // namespace anticrack::meshes
