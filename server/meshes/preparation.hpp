// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a mesh gets from its definition to its operators.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "errors/errors.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "meshes/mesh_index.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

/// Each mesh that is wanted has a run (mesh_index.hpp), on a thread from its first step to its
/// last. Of each class of sizes (size_class.hpp) two runs are under way at a time, the others wait
/// in the order they came.
///
/// The mutex guards the index and the runs and is never held while the store is asked or written. A
/// record has one writer at a time: whoever claimed it (to make or to erase it), else its run. The
/// index follows the disk: a stage is entered when the record that says so has been written. Of the
/// states of a mesh the disk knows PENDING, EVICTED (meshed) and FAILED; the others are what goes
/// on in memory.
class Preparation {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using Operator = std::shared_ptr<const operators::MeshOperator>;

  /// Reads all records. What an earlier run of the server left unmeshed is begun at once, oldest
  /// first.
  Preparation(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops what is under way.
  ~Preparation();

  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// Of everything here.
  Lock lock() const { return Lock(_mutex); }

  // With the lock held:
  MeshIndex& index() noexcept { return _index; }
  /// Wakes all who wait for a change of the index.
  void notify() { _changed.notify_all(); }
  /// Waits until the record of the mesh is not being written; null where there is no such mesh.
  LiveMesh* settled(Lock& lock, const std::string& id);
  /// Has the mesh prepared, however little is left to do. The mesh must be known and settled.
  std::shared_ptr<Run> begin(const std::string& id, bool background);
  /// Runs in the background that have not begun.
  std::size_t queued() const;

  // Without it:
  /// The record with the state of this moment. Throws errors::Error (not_found).
  store::MeshRecord record(const std::string& id);
  /// MeshCatalogue::prepare.
  Operator prepare(const std::string& id, const PhaseListener& listener,
                   const std::stop_token& stop);
  std::uint64_t meshings() const noexcept { return _meshings; }

 private:
  using RunPtr = std::shared_ptr<Run>;

  void recover();
  store::MeshRecord stored(const std::string& id) const;
  /// The mesh of a run; null where the run is over, or nobody wants it any more.
  LiveMesh* mesh_of(const Run& run);
  /// Returns when the run has ended.
  void await(Lock& lock, Run& run, bool joins, const PhaseListener& listener,
             const std::stop_token& stop);
  /// One waiter fewer. True where the run is to be stopped, as nobody wants it any more.
  bool leave(Run& run);

  // On the thread of a run:
  void work();
  /// The next run that may begin, under way now; null where there is none.
  RunPtr take();
  void perform(Run& run);
  std::shared_ptr<const mesh::Mesh> triangulate(Run& run);
  void factorize(Run& run, std::shared_ptr<const mesh::Mesh> triangulation);
  void record_outcome(Lock& lock, LiveMesh& mesh, const std::string& id);
  void fail(Run& run, errors::Error error);
  void finish(Run& run);

  const CatalogueOptions _options;
  store::Store& _store;
  operators::OperatorCache& _cache;
  std::atomic<std::uint64_t> _meshings{0};

  mutable std::mutex _mutex;
  std::condition_variable_any _changed;  ///< the index, or a run
  MeshIndex _index;
  std::list<RunPtr> _queue;
  std::list<RunPtr> _under_way;
  std::stop_source _stopping;
  int _idle = 0;
  std::list<std::jthread> _threads;  ///< as many as there ever were runs at a time, and one
};

}  // namespace anticrack::meshes
