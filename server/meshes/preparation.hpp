// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a mesh gets from its definition to operators, in the background and for whoever waits.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "errors/errors.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "meshes/mesh_index.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

/// Meshing is done by the threads of this object alone, one run of the helper a mesh. Factorising
/// is shared through the cache: a caller that comes meanwhile joins.
///
/// The mutex guards the index and is never held while the store is asked or written. A record has
/// one writer at a time: whoever claimed it (to make or to erase it), else the thread that runs it
/// while it is pending, else the first of those who factorise it together. The index follows the
/// disk: a stage is entered when the record that says so has been written. Of the states of a mesh
/// the disk knows PENDING, EVICTED (meshed) and FAILED; the others are what goes on in memory.
class Preparation {
 public:
  using Operator = std::shared_ptr<const operators::MeshOperator>;

  /// Reads all records. What an earlier run of the server left unmeshed is scheduled at once,
  /// oldest first.
  Preparation(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops what is under way.
  ~Preparation();

  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// Of everything here.
  std::unique_lock<std::mutex> lock() const { return std::unique_lock(_mutex); }

  // With the lock held:
  MeshIndex& index() noexcept { return _index; }
  const MeshIndex& index() const noexcept { return _index; }
  /// Wakes all who wait for a change of the index.
  void notify() { _changed.notify_all(); }
  /// Waits until nobody is making or erasing the mesh.
  void wait_for_claim(std::unique_lock<std::mutex>& lock, const std::string& id);
  /// Waits until a run in the background that has told how it ended is over: soon.
  void wait_for_end(std::unique_lock<std::mutex>& lock, const std::string& id);

  // Without it:
  /// The record with the state of this moment. Throws errors::Error (not_found).
  store::MeshRecord record(const std::string& id) const;
  /// MeshCatalogue::prepare.
  Operator prepare(const std::string& id, const PhaseListener& listener,
                   const std::stop_token& stop);
  std::uint64_t meshings() const noexcept { return _meshings; }

 private:
  class Visit;
  /// What came of a factorisation; neither: it was stopped, or something passing was in the way.
  struct Outcome {
    std::optional<Measured> measured;
    std::optional<errors::Error> failure;
  };

  struct Meshed {
    std::shared_ptr<const mesh::Mesh> mesh;
    std::uint64_t round = 0;
  };

  void recover();
  store::MeshRecord stored(const std::string& id) const;
  /// The round of those who wait together for its operators.
  static std::uint64_t begin_factorizing(LiveMesh& mesh);
  void end_factorizing(const std::string& id, std::uint64_t round, Outcome outcome, bool last_step);
  bool record_outcome(std::unique_lock<std::mutex>& lock, const std::string& id,
                      const Outcome& outcome);
  bool write_outcome(const std::string& id, const Outcome& outcome);
  Operator load(const std::string& id, std::shared_ptr<const mesh::Mesh> mesh,
                const std::stop_token& stop);
  Operator factorize(const std::string& id, std::uint64_t round,
                     std::shared_ptr<const mesh::Mesh> mesh, bool hold,
                     const std::stop_token& stop);
  /// And begins a round.
  Meshed triangulate(const std::string& id);
  void prepare_in_background(const std::string& id);
  void set_back(const std::string& id, errors::Error error);
  void work();

  const CatalogueOptions _options;
  store::Store& _store;
  operators::OperatorCache& _cache;
  std::atomic<std::uint64_t> _meshings{0};
  std::stop_source _stopping;

  mutable std::mutex _mutex;
  std::condition_variable_any _changed;  ///< the index
  MeshIndex _index;

  std::vector<std::jthread> _threads;
};

}  // namespace anticrack::meshes
