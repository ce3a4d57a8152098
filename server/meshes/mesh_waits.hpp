// SPDX-License-Identifier: GPL-3.0-or-later
//
// How one waits for meshes without a thread that sleeps.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "errors/errors.hpp"
#include "operators/mesh_operator.hpp"
#include "records/records.hpp"

namespace anticrack::meshes {

class MeshCatalogue;
class Preparation;

/// What has become of a mesh that somebody waits for.
struct MeshNews {
  enum class Phase { queued, meshing, factorising, waits_for_memory, ready, failed };

  std::uint64_t wait = 0;
  std::string mesh = {};  ///< id
  Phase phase = Phase::queued;
  std::optional<records::MeshProgress> progress = {};  ///< of the mesher, about every second
  std::shared_ptr<const operators::MeshOperator> mesh_operator = {};  ///< ready
  std::optional<errors::Error> error = {};                            ///< failed
};

/// The waits of one who needs operators. Thread-safe; no method but the
/// destructor blocks, so they may be called under any lock. The destructor gives up all waits and
/// returns when no call is under way: destroy it outside of those calls, and under no lock that
/// they take.
///
/// News is told on a thread of the catalogue, call after call and in order, with no lock held. The
/// last of a wait is `ready` or `failed`; none begins after end(), but one may be under way. After
/// `waits_for_memory` the mesh is tried again by itself, whenever the cache says.
class MeshWaits {
 public:
  using Tell = std::function<void(const MeshNews&)>;

  /// `tell` must not throw. The catalogue must outlive it.
  MeshWaits(MeshCatalogue& catalogue, Tell tell);
  ~MeshWaits();
  MeshWaits(const MeshWaits&) = delete;
  MeshWaits& operator=(const MeshWaits&) = delete;

  /// Meshes and factorises if necessary; returns the number of the wait, above 0. It fails with the
  /// error of a failed mesh, not_found, or disk_full or storage if the mesh could not be written.
  std::uint64_t begin(const std::string& mesh, records::Priority priority,
                      std::chrono::steady_clock::time_point since);
  /// One more with this priority waits.
  void join(std::uint64_t wait, records::Priority priority,
            std::chrono::steady_clock::time_point since);
  /// Gives up; or after `ready`, the operators have been taken up: until then they hold a place of
  /// those that are made ahead (queue.hpp). Does nothing if there is no such wait.
  void end(std::uint64_t wait);

 private:
  friend class Preparation;
  void end_held(std::uint64_t wait);

  Preparation& _preparation;
  const Tell _tell;
};

}  // namespace anticrack::meshes
