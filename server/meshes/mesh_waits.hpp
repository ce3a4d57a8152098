// SPDX-License-Identifier: GPL-3.0-or-later
//
// Lets a user wait for meshes without a thread that sleeps.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "errors/errors.hpp"
#include "records/mesh_record.hpp"
#include "records/priority.hpp"

namespace anticrack::operators {
class MeshOperator;
}  // namespace anticrack::operators

namespace anticrack::meshes {

class MeshCatalogue;
class Preparation;

/// News of a mesh for which somebody waits.
struct MeshNews {
  enum class Phase { queued, meshing, factorising, waits_for_memory, ready, failed };

  std::uint64_t wait = 0;
  std::string mesh = {};  ///< id
  Phase phase = Phase::queued;
  std::optional<records::MeshProgress> progress = {};  ///< while meshing, about every second
  std::shared_ptr<const operators::MeshOperator> mesh_operator = {};  ///< if ready
  std::optional<errors::Error> error = {};                            ///< if failed
};

/// The waits of one user of operators. Thread-safe; no method but the destructor blocks, so methods
/// may be called under any lock. The destructor gives up all waits and returns when no call of
/// `tell` is running: destroy it outside of `tell`, and under no lock that `tell` takes.
///
/// A thread of the catalogue calls `tell` with news, one call at a time and in order, with no lock
/// held. The last news of a wait is `ready` or `failed`. No call for a wait begins after end(), but
/// one may still be running. After `waits_for_memory` the mesh is tried again when the cache says
/// so.
class MeshWaits {
 public:
  using Tell = std::function<void(const MeshNews&)>;

  /// `tell` must not throw. The catalogue must outlive it.
  MeshWaits(MeshCatalogue& catalogue, Tell tell);
  ~MeshWaits();
  MeshWaits(const MeshWaits&) = delete;
  MeshWaits& operator=(const MeshWaits&) = delete;

  /// Begins a wait for a mesh, which is meshed and factorised if necessary; returns the number of
  /// the wait, above 0. The wait fails with the error of a failed mesh, not_found, or disk_full or
  /// storage if the mesh could not be written.
  std::uint64_t begin(const std::string& mesh, records::Priority priority,
                      std::chrono::steady_clock::time_point since);
  /// Adds another one who waits, with this priority.
  void join(std::uint64_t wait, records::Priority priority,
            std::chrono::steady_clock::time_point since);
  /// Gives the wait up. After `ready`, call it when the operators are in use: until then they hold
  /// one of the places for operators made ahead (queue.hpp). Does nothing if there is no such wait.
  void end(std::uint64_t wait);

 private:
  friend class Preparation;
  void end_held(std::uint64_t wait);

  Preparation& _preparation;
  const Tell _tell;
};

}  // namespace anticrack::meshes
