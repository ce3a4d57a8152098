// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prepares meshes: from the definition to the operators.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "meshes/mesh_index.hpp"
#include "meshes/queue.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

/// Each requested mesh has a run (mesh_index.hpp) on one thread, when the queue says so. What a
/// run is can be read in preparation_run.cpp; what waits, is begun again or given up, and how who
/// waits is told, in preparation.cpp.
///
/// The mutex guards the index, the queue and the runs; it is never held during calls of the store,
/// of those who wait, or of a stop. A record has one writer at a time: whoever claimed it (to make
/// or erase it), else its run. The index follows the disk: a stage changes after the record has
/// been written.
class Preparation {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using Operator = std::shared_ptr<const operators::MeshOperator>;

  /// Reads all records and begins those that are pending, oldest first.
  Preparation(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops all runs. Nobody may wait any more.
  ~Preparation();

  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// Locks the index and the runs.
  Lock lock() const { return Lock(_mutex); }
  /// Locks when no thread writes the record of the mesh, or there is no such mesh.
  Lock lock_settled(const std::string& id);

  // With the lock held:
  MeshIndex& index() noexcept { return _index; }
  /// Wakes all threads after a change of the index.
  void notify() { _changed.notify_all(); }
  /// Starts a run or keeps the one there is. The mesh must be known and settled.
  Run& begin(const std::string& id, bool background);
  /// Does what the mesh's waits need: gives them the operators, its error, or a run.
  void serve(const std::string& id);
  /// Takes the run off the mesh, which must be settled. Request its stop without the lock. Null if
  /// there is none.
  std::shared_ptr<Run> give_up(LiveMesh& mesh);
  /// Ends the waits of the mesh without operators.
  void fail_waits(LiveMesh& mesh, const errors::Error& why);
  /// Number of background runs, and of meshes to be meshed, that have not begun.
  std::size_t queued() const;

  // Without it:
  /// The record with its current state. Throws errors::Error (not_found).
  records::MeshRecord record(const std::string& id);
  /// The last job that used the mesh has ended: stops its run if nobody else wants it.
  void let_go(const std::string& id);
  std::uint64_t meshings() const noexcept { return _meshings; }

 private:
  using RunPtr = std::shared_ptr<Run>;
  using Steady = std::chrono::steady_clock;
  friend class MeshWaits;

  void recover();
  records::MeshRecord stored(const std::string& id) const;
  /// The mesh of a run; null if the run is over or was abandoned.
  LiveMesh* mesh_of(const Run& run);
  /// Takes the run off the mesh if nobody wants it, and has it stopped.
  void give_up_unwanted(LiveMesh& mesh);

  // What those who wait are told:
  void tell(const std::shared_ptr<Wait>& wait, MeshNews news);
  void tell_phase(LiveMesh& mesh, MeshNews::Phase phase);
  /// Ends the waits of the mesh: with operators, which pin `place` of the queue if it is not 0.
  void hand_over(LiveMesh& mesh, const Operator& ready, std::uint64_t place);
  /// The thread that tells it, and stops what was given up.
  void deliver();

  // On the thread of a run:
  void work();
  /// Activates the next run that may begin; null if there is none.
  RunPtr take();
  void perform(Run& run);
  std::shared_ptr<const mesh::Mesh> triangulate(Run& run);
  /// Locks when nobody else writes the record of the run's mesh, and marks that the run does; null:
  /// the run was given up.
  std::pair<Lock, LiveMesh*> lock_to_write(Run& run);
  void end_writing(Run& run);
  /// Begins again what the disk refused or had no memory, now that it is due.
  void begin_due();
  void begin_later(LiveMesh& mesh, const std::string& id);
  void factorize(Run& run, std::shared_ptr<const mesh::Mesh> triangulation);
  void record_outcome(Run& run);
  void fail(Run& run, errors::Error error);
  void finish(Run& run);

  const CatalogueOptions _options;
  store::Store& _store;
  operators::OperatorCache& _cache;
  std::atomic<std::uint64_t> _meshings{0};

  mutable std::mutex _mutex;
  std::condition_variable_any _changed;  ///< the index, or a run
  MeshIndex _index;
  Queue _queue;
  std::map<std::uint64_t, RunPtr> _queued, _under_way;    ///< by number in the queue
  std::multimap<Steady::time_point, std::string> _later;  ///< meshes to retry
  std::map<std::uint64_t, std::shared_ptr<Wait>> _waits;  ///< that have not been ended
  std::uint64_t _last_wait = 0;
  std::condition_variable _to_deliver, _delivered;
  std::deque<std::pair<std::shared_ptr<Wait>, MeshNews>> _news;
  std::vector<RunPtr> _unwanted;        ///< to be stopped
  const MeshWaits* _telling = nullptr;  ///< whose call is under way
  std::stop_source _stopping;
  int _idle = 0;
  std::list<std::jthread> _threads;  ///< one to deliver, one more than the most active runs so far
};

}  // namespace anticrack::meshes
