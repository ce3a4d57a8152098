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

struct Triangulation;

/// Each requested mesh has a run (mesh_index.hpp) on one thread, which begins when the queue says
/// so. preparation_run.cpp has the work of a run; preparation.cpp begins runs, retries them and
/// gives them up, and tells the news to those who wait.
///
/// The mutex guards the index, the queue and the runs; it is never held during calls of the store,
/// of `tell`, or of a stop. A record has one writer at a time: the thread that claimed it (to make
/// or erase it), else its run. The index follows the disk: a stage changes after the record has
/// been written.
class Preparation {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using Operator = std::shared_ptr<const operators::MeshOperator>;

  /// Reads all records and begins those that are pending, oldest first.
  Preparation(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops all runs. There must be no waits left.
  ~Preparation();

  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// Locks the index and the runs.
  Lock lock() const { return Lock(_mutex); }
  /// Locks as soon as no thread writes the record of the mesh, or there is no such mesh.
  Lock lock_settled(const std::string& id);

  // With the lock held:
  MeshIndex& index() noexcept { return _index; }
  /// Wakes all threads after a change of the index.
  void notify() { _changed.notify_all(); }
  /// Starts a run or keeps the one there is. The mesh must be known and settled.
  Run& begin(const std::string& id, bool background);
  /// Gives the waits of the mesh what they need: the operators, its error, or a run.
  void serve(const std::string& id);
  /// Takes the run off the mesh, which must be settled. Request its stop without the lock. Null if
  /// there is none.
  std::shared_ptr<Run> give_up(LiveMesh& mesh);
  /// Ends the waits of the mesh with an error.
  void fail_waits(LiveMesh& mesh, const errors::Error& why);
  /// The number of background runs and of meshes to be meshed that have not begun.
  std::size_t queued() const;

  // Without the lock:
  /// Where other servers make and erase meshes of the store, too: brings the index up to the
  /// record, unless this server is at work on the mesh.
  void look_again(const std::string& id);
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
  /// Takes the run off the mesh and has it stopped, if nobody wants it.
  void give_up_unwanted(LiveMesh& mesh);

  // News for those who wait:
  void tell(const std::shared_ptr<Wait>& wait, MeshNews news);
  void tell_phase(LiveMesh& mesh, MeshNews::Phase phase);
  /// Ends the waits of the mesh with operators, which hold `place` of the queue if it is not 0.
  void hand_over(LiveMesh& mesh, const Operator& ready, std::uint64_t place);
  /// The work of the thread that tells the news and stops runs that were given up.
  void deliver();

  // On the thread of a run:
  void work();
  /// Takes the next run that may begin; null if there is none.
  RunPtr take();
  void perform(Run& run);
  /// Not in the store yet; one that the mesher made has no summary yet.
  Triangulation triangulate(Run& run);
  /// Summarises and stores it.
  void keep(Run& run, Triangulation& made);
  /// Locks as soon as nobody else writes the record of the run's mesh, and marks that the run
  /// writes it. The mesh is null if the run was given up.
  std::pair<Lock, LiveMesh*> lock_to_write(Run& run);
  void end_writing(Run& run);
  /// Begins the runs again that are due after the disk refused or memory was short.
  void begin_due();
  void begin_later(LiveMesh& mesh, const std::string& id);
  /// `triangulation`: null: that of the store.
  Operator operators_of(const Run& run, const std::string& sha256, const std::string& owner,
                        std::shared_ptr<const mesh::Mesh> triangulation);
  /// `made`: as by triangulate(); null: the mesh is in the store.
  void factorize(Run& run, Triangulation* made);
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
  std::map<std::uint64_t, std::shared_ptr<Wait>> _waits;  ///< waits before their end()
  std::uint64_t _last_wait = 0;
  std::condition_variable _to_deliver, _delivered;
  std::deque<std::pair<std::shared_ptr<Wait>, MeshNews>> _news;
  std::vector<RunPtr> _unwanted;        ///< runs to be stopped
  const MeshWaits* _telling = nullptr;  ///< the one whose `tell` is running
  std::stop_source _stopping;
  int _idle = 0;
  std::list<std::jthread> _threads;  ///< one that delivers, the others for runs
};

}  // namespace anticrack::meshes
