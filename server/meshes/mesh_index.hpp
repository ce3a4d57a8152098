// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the catalogue has in memory of every mesh: enough to say where it stands without the disk.
// Not thread-safe: guarded by the catalogue's mutex (preparation.hpp).
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "errors/errors.hpp"
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

struct LiveMesh {
  Stage stage = Stage::absent;
  bool claimed = false;                ///< somebody writes its record to make or to erase it
  std::uint64_t version = 0;           ///< grows with each change of what the record says
  std::string definition;              ///< hash, whoever owns it
  std::string sha256;                  ///< of the triangulation; empty: not meshed
  std::optional<errors::Error> error;  ///< when failed
  Measured operators;

  // In the background:
  bool queued = false;
  bool running = false;  ///< in the hands of a thread
  bool ending = false;   ///< that thread has told how it ended, and soon lets go of it
  bool again = false;    ///< to be queued when it lets go of it
  bool meshing = false;
  bool pin = false;                      ///< to be pinned once its operators are there
  int setbacks = 0;                      ///< runs that ended without mesh and without failure
  std::optional<errors::Error> setback;  ///< why the last of them did

  // For those who wait:
  int waiting = 0;          ///< calls of prepare()
  bool undecided = false;   ///< those who wait together for its operators know nothing yet
  std::uint64_t round = 0;  ///< number of that round
  int factorizing = 0;      ///< threads in it
  bool writing = false;     ///< what came of one is on its way to the disk
  std::chrono::steady_clock::time_point since;
  std::weak_ptr<void> users;  ///< jobs that have not ended

  /// Whether a preparation is to come, or under way and not ending.
  bool scheduled() const { return queued || again || (running && !ending); }
};

/// The record with the state it is in at this moment; `in_memory`: its operators are.
store::MeshRecord seen(const LiveMesh& mesh, store::MeshRecord record, bool in_memory);

class MeshIndex {
 public:
  /// A mesh of an earlier run of the server. What it had not meshed has to be scheduled.
  LiveMesh& add(const store::MeshRecord& record);
  /// An absent one.
  LiveMesh& add(const std::string& id) { return _meshes[id]; }
  void remove(const std::string& id) { _meshes.erase(id); }
  std::size_t size() const { return _meshes.size(); }

  // References stay good until remove().
  LiveMesh* find(const std::string& id);
  const LiveMesh* find(const std::string& id) const;
  /// Throws errors::Error (not_found), also where it is absent.
  LiveMesh& known(const std::string& id);
  const LiveMesh& known(const std::string& id) const;

  /// Has a mesh prepared in the background, once more where that is about to end.
  void schedule(const std::string& id);
  bool any_queued() const { return !_queue.empty(); }
  std::size_t queued() const { return _queue.size(); }
  /// The next one, running now.
  std::string take();
  /// Its thread is done with it.
  void release(const std::string& id);

  /// Meshes waiting for the mesher or in it. O(n).
  int pending() const;
  /// Another mesh made from the same definition that has a triangulation; empty: none. O(n).
  std::string twin(const std::string& id) const;
  /// Another mesh has the same triangulation. O(n).
  bool shared(const std::string& id) const;

 private:
  std::unordered_map<std::string, LiveMesh> _meshes;
  std::deque<std::string> _queue;
};

}  // namespace anticrack::meshes
