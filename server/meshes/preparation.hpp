// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prepares meshes: from the definition to the operators.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <unordered_map>

#include "errors/errors.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "meshes/mesh_index.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

/// Each requested mesh has a run (mesh_index.hpp) on one thread. Two runs per size class
/// (size_class.hpp) are active at a time, and up to four if each of the others is the only one of
/// an owner with a name. Of those that wait the next is of the owner who has the fewest under way,
/// then of who had a start longest ago, then the one that came first.
///
/// The mutex guards the index and the runs; it is never held during calls of the store. A record
/// has one writer at a time: whoever claimed it (to make or erase it), else its run. The index
/// follows the disk: a stage changes after the record has been written.
class Preparation {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using Operator = std::shared_ptr<const operators::MeshOperator>;

  /// Reads all records and begins those that are pending, oldest first.
  Preparation(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops all runs.
  ~Preparation();

  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// Locks the index and the runs.
  Lock lock() const { return Lock(_mutex); }

  // With the lock held:
  MeshIndex& index() noexcept { return _index; }
  /// Wakes all waiters after a change of the index.
  void notify() { _changed.notify_all(); }
  /// Waits until no thread writes the record of the mesh; null if there is no such mesh.
  LiveMesh* settled(Lock& lock, const std::string& id);
  /// Starts or joins a run. The mesh must be known and settled.
  std::shared_ptr<Run> begin(const std::string& id, bool background);
  /// Takes the run off the mesh, which must be settled; its waiters get the error. Request its stop
  /// without the lock. Null if there is none.
  std::shared_ptr<Run> give_up(LiveMesh& mesh, const errors::Error& why);
  /// Number of background runs, and of meshes to be meshed, that have not begun.
  std::size_t queued() const;

  // Without it:
  /// The record with its current state. Throws errors::Error (not_found).
  store::MeshRecord record(const std::string& id);
  /// MeshCatalogue::prepare.
  Operator prepare(const std::string& id, const PhaseListener& listener,
                   const std::stop_token& stop, const ProgressListener& progress);
  /// The last job that used the mesh has ended: stops its run if nobody else wants it.
  void let_go(const std::string& id);
  std::uint64_t meshings() const noexcept { return _meshings; }

 private:
  using RunPtr = std::shared_ptr<Run>;

  void recover();
  store::MeshRecord stored(const std::string& id) const;
  /// The mesh of a run; null if the run is over or was abandoned.
  LiveMesh* mesh_of(const Run& run);
  /// Waits for the end of the run.
  void await(Lock& lock, Run& run, bool joins, const PhaseListener& listener,
             const std::stop_token& stop, const ProgressListener& progress);
  /// Removes a waiter. True if the run has no other: stop it then.
  bool leave(Run& run);

  // On the thread of a run:
  void work();
  /// Activates the next run that may begin; null if there is none.
  RunPtr take();
  bool may_begin(const Run& run) const;
  void perform(Run& run);
  std::shared_ptr<const mesh::Mesh> triangulate(Run& run);
  /// The mesh of a run that is about to write its record; null if the run was given up.
  LiveMesh* begin_writing(Lock& lock, Run& run);
  void end_writing(Run& run);
  /// Begins again what the disk refused, now that it is due.
  void begin_due();
  void begin_later(LiveMesh& mesh, const std::string& id);
  void factorize(Run& run, std::shared_ptr<const mesh::Mesh> triangulation);
  void record_outcome(Lock& lock, Run& run);
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
  std::multimap<std::chrono::steady_clock::time_point, std::string> _later;  ///< meshes to retry
  std::unordered_map<std::string, std::uint64_t> _started;  ///< by owner: when, in starts
  std::uint64_t _starts = 0;
  std::stop_source _stopping;
  int _idle = 0;
  std::list<std::jthread> _threads;  ///< one more than the most active runs so far
};

}  // namespace anticrack::meshes
