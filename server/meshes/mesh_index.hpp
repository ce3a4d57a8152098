// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the catalogue keeps in memory of every mesh: enough to say where it stands without the disk.
// Not thread-safe: guarded by the catalogue's mutex (preparation.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <unordered_map>

#include "errors/errors.hpp"
#include "operators/mesh_operator.hpp"
#include "store/records.hpp"

namespace anticrack::meshes {

/// What has been reached for good, as the record on the disk says it.
enum class Stage {
  absent,  ///< being made or being erased: as good as not there
  pending,
  meshed,
  failed,
};

/// Of the operators, when they were last in memory.
struct Measured {
  std::uint64_t bytes = 0;  ///< 0: they never were
  double theta_star = 0;
  double seconds = 0;
};

/// A mesh on its way to its operators. All who want them share one run. When the last waiter leaves
/// a run that is not in the background, it is stopped and is the mesh's no more.
struct Run {
  const std::string id;
  const int size_class;
  std::stop_source stop = {};

  store::MeshState phase = store::MeshState::pending;  ///< or meshing, factorizing
  bool background = false;                             ///< goes on where nobody waits
  int waiters = 0;
  bool told = false;    ///< the operators are there for all to see
  bool ending = false;  ///< only its outcome is left to be written
  std::shared_ptr<const operators::MeshOperator> result = {};  ///< until the last waiter has it
  std::optional<errors::Error> error = {};
};

struct LiveMesh {
  Stage stage = Stage::absent;
  bool claimed = false;                ///< somebody writes its record to make or to erase it
  std::uint64_t version = 0;           ///< grows with each change of what the record says
  std::string definition;              ///< hash, whoever owns it
  std::string sha256;                  ///< of the triangulation; empty: not meshed
  std::optional<errors::Error> error;  ///< when failed
  Measured operators;
  int size_class = 0;         ///< by the triangles it has, or is expected to have
  bool pin = false;           ///< to be pinned once its operators are there
  std::shared_ptr<Run> run;   ///< null: it is not being prepared
  std::weak_ptr<void> users;  ///< jobs that have not ended
};

/// The record with the state it is in at this moment; `in_memory`: its operators are.
store::MeshRecord seen(const LiveMesh& mesh, store::MeshRecord record, bool in_memory);

class MeshIndex {
 public:
  /// A mesh of an earlier run of the server.
  LiveMesh& add(const store::MeshRecord& record);
  /// An absent one, unless it is there.
  LiveMesh& add(const std::string& id) { return _meshes[id]; }
  void remove(const std::string& id) { _meshes.erase(id); }
  std::size_t size() const { return _meshes.size(); }

  // References stay good until remove().
  /// Null where there is none.
  LiveMesh* find(const std::string& id);
  /// Throws errors::Error (not_found), also where it is absent.
  LiveMesh& known(const std::string& id);

  /// Meshes waiting for the mesher or in it. O(n).
  int pending() const;
  /// Another mesh made from the same definition that has a triangulation; empty: none. O(n).
  std::string twin(const std::string& id) const;
  /// Another mesh has the same triangulation. O(n).
  bool shared(const std::string& id) const;

 private:
  std::unordered_map<std::string, LiveMesh> _meshes;
};

}  // namespace anticrack::meshes
