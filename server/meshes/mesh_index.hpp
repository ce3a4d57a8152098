// SPDX-License-Identifier: GPL-3.0-or-later
//
// The state of every mesh, kept in memory. Not thread-safe: Preparation's mutex guards it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "meshes/mesh_waits.hpp"
#include "records/mesh_record.hpp"
#include "records/priority.hpp"

namespace anticrack::operators {
class MeshOperator;
}  // namespace anticrack::operators

namespace anticrack::meshes {

/// The state of the record on disk.
enum class Stage {
  absent,  ///< being made or erased; treated as missing
  pending,
  meshed,
  failed,
};

/// Sizes that were measured when the operators were last in memory.
struct Measured {
  std::uint64_t bytes = 0;  ///< 0: never measured
  double seconds = 0;
};

/// A wait for the operators of a mesh.
struct Wait {
  const std::uint64_t number;
  const MeshWaits* const whose;
  const std::string mesh;  ///< id
  const records::Priority priority;
  const std::chrono::steady_clock::time_point since;
  std::optional<MeshNews::Phase> told = {};
  bool joined = false;      ///< whether it joined a run that was there
  bool over = false;        ///< whether it was given up
  std::uint64_t place = 0;  ///< place in the queue that it holds, with the operators
};

/// The preparation of a mesh up to its operators, shared by all its waits. A run that is not in the
/// background is stopped and detached from the mesh when the last wait is given up, or when no job
/// uses the mesh any more; any run is when the mesh is erased.
struct Run {
  const std::string id;
  const std::uint64_t place = 0;  ///< in the queue
  std::stop_source stop = {};

  records::MeshState phase = records::MeshState::pending;  ///< then meshing, factorizing
  bool background = false;                                 ///< whether it goes on without waits
  bool visible = false;                                    ///< the operators, to every caller
  bool ending = false;                                     ///< only its outcome is to be written
  bool writing = false;                                ///< its record; it is not given up meanwhile
  std::optional<records::MeshProgress> progress = {};  ///< progress of the mesher
};

struct LiveMesh {
  Stage stage = Stage::absent;
  bool claimed = false;       ///< its record is being made or erased
  std::uint64_t version = 0;  ///< incremented with each change of the record
  std::string definition;     ///< hash, without the owner
  std::string owner;
  std::string sha256;                  ///< of the triangulation; empty: not meshed
  std::optional<errors::Error> error;  ///< if the mesh failed
  Measured operators;
  int size_class = 0;                        ///< by its actual or expected triangles
  bool for_job = false;                      ///< only jobs want it
  bool used = false;                         ///< whether a job has ever used it
  int refusals = 0;                          ///< how often in a row the disk has refused
  bool pin = false;                          ///< pin its operators once they are made
  std::shared_ptr<Run> run;                  ///< null: it is not being prepared
  std::vector<std::shared_ptr<Wait>> waits;  ///< waits without an outcome yet, in their order
  std::weak_ptr<void> users;                 ///< jobs that have not ended
};

/// The record with its current state. `in_memory`: its operators are in memory.
records::MeshRecord seen(const LiveMesh& mesh, records::MeshRecord record, bool in_memory);

class MeshIndex {
 public:
  /// Adds a mesh from the store.
  LiveMesh& add(const records::MeshRecord& record);
  /// Finds the mesh or adds an absent one.
  LiveMesh& add(const std::string& id) { return _meshes[id]; }
  void remove(const std::string& id) { _meshes.erase(id); }
  std::size_t size() const { return _meshes.size(); }

  // References stay good until remove().
  /// Null if there is none.
  LiveMesh* find(const std::string& id);
  /// Like find(), but throws errors::Error (not_found) for a missing or absent mesh.
  LiveMesh& known(const std::string& id);

  /// The meshes whose operators were measured.
  std::vector<std::pair<std::string, std::string>> measured() const;  ///< id, sha256
  /// Meshes that wait for the mesher or are in it. O(n).
  int pending() const;
  /// Another mesh with the same definition that has a triangulation; empty if there is none. O(n).
  std::string twin(const std::string& id) const;
  /// Whether another mesh has the same triangulation. O(n).
  bool shared(const std::string& id) const;

 private:
  std::unordered_map<std::string, LiveMesh> _meshes;
};

/// Whether the same mesh would always meet this error again, so that the mesh counts as failed.
/// After any other error its state does not change, and its waiters get the error.
inline bool lasting(const errors::Error& error) noexcept {
  using errors::Reason;
  const Reason reason = error.reason();
  return reason != Reason::busy && reason != Reason::cancelled && reason != Reason::disk_full &&
         reason != Reason::storage;
}

}  // namespace anticrack::meshes
