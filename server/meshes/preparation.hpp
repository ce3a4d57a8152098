// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a mesh gets from its definition to operators, in the background and for whoever waits.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "errors/errors.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

/// Meshing is done by the threads of this object alone, one run of the helper a mesh. Factorising
/// is shared through the cache: a caller that comes meanwhile joins. A record's state in the store
/// is the last step that was completed or begun; `seen_now` says what is true of the operators.
class Preparation {
 public:
  using Operator = std::shared_ptr<const operators::MeshOperator>;

  Preparation(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops what is under way.
  ~Preparation();

  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  /// Held while a record is read, changed and put.
  std::unique_lock<std::mutex> lock() const { return std::unique_lock(_mutex); }

  // With the lock held:
  /// Throws errors::Error (not_found).
  store::MeshRecord stored(const std::string& id) const;
  /// The record with the state the operators are in at this moment.
  store::MeshRecord seen_now(store::MeshRecord record) const;
  bool full() const { return _queue.size() >= _options.max_pending; }
  /// Has a mesh prepared in the background, once more where that is about to end.
  void schedule(const std::string& id);

  // Without it:
  /// MeshCatalogue::prepare.
  Operator prepare(const std::string& id, const PhaseListener& listener,
                   const std::stop_token& stop);
  /// Path of an upload. Throws errors::Error (not_found).
  std::string require_upload(const store::UploadRef& upload) const;
  std::uint64_t meshings() const noexcept { return _meshings; }

 private:
  /// What is going on with a mesh.
  struct Live {
    bool scheduled = false;  ///< in the queue, or in the hands of a thread of this object
    bool again = false;      ///< to be queued when that thread lets go of it
    int factorizing = 0;     ///< callers that wait for its operators
    std::chrono::steady_clock::time_point since;
  };

  void put(const store::MeshRecord& record);
  void enqueue(const std::string& id);
  void release(const std::string& id);
  void forget_if_idle(const std::string& id);
  void begin_factorizing(store::MeshRecord record);
  void end_factorizing(const std::string& id, const Operator& result,
                       const std::optional<errors::Error>& error);
  Operator factorize(const std::string& id, const std::string& sha256, const std::stop_token& stop);
  void triangulate(const std::string& id);
  void prepare_in_background(const std::string& id);
  void fail(const std::string& id, const errors::Error& error);
  void work();

  const CatalogueOptions _options;
  store::Store& _store;
  operators::OperatorCache& _cache;
  std::atomic<std::uint64_t> _meshings{0};
  std::stop_source _stopping;

  mutable std::mutex _mutex;
  std::condition_variable_any _changed;  ///< a record, or the queue
  std::deque<std::string> _queue;
  std::unordered_map<std::string, Live> _live;

  std::vector<std::jthread> _threads;
};

}  // namespace anticrack::meshes
