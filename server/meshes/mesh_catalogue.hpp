// SPDX-License-Identifier: GPL-3.0-or-later
//
// The meshes the server knows: from their definition to a triangulation (in the helper process) to
// factorised operators (in the cache).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "mesher/helper.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

struct CatalogueOptions {
  mesher::HelperOptions helper;
  std::size_t max_triangles = 4'000'000;
  std::size_t max_pending = 64;     ///< meshes waiting for the mesher, then `busy`
  std::size_t max_meshes = 10'000;  ///< records; then limit_exceeded: delete some
  /// Told of each mesh the helper made or failed to make, without a lock. Must not throw.
  std::function<void(const store::MeshRecord&)> meshed = {};
};

/// A mesh on its way to READY: phases for whoever waits.
using PhaseListener = std::function<void(store::MeshState)>;

/// Meshes and factorises new meshes in the background, two of each class of sizes (size_class.hpp)
/// at a time in the order they came: a large mesh holds up no smaller one. Thread-safe.
///
/// The disk knows a mesh as PENDING, EVICTED (meshed) or FAILED. What an earlier run of the server
/// left unmeshed is scheduled at its start, oldest first; the rest is as it was, without operators.
/// A mesh the disk has no room for is PENDING again, and who waits for it is told; it is tried
/// again when somebody creates, warms or prepares it.
class MeshCatalogue {
 public:
  /// Takes up what an earlier run left. `store` and `cache` must outlive it.
  MeshCatalogue(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops what is under way (kills the helper).
  ~MeshCatalogue();

  /// Checks the definition (errors::Error: geometry_invalid, invalid_argument, not_found for an
  /// upload, busy, limit_exceeded, disk_full) and returns its record: the one that is there already
  /// for the same definition, or a new one, `pending`, which is on the disk then. A failed one is
  /// tried again. Does not wait for the mesher.
  /// Owners share triangulations and operators of equal meshes, but no records.
  store::MeshRecord create(const store::MeshDefinition& definition, const std::string& title,
                           const std::string& owner);

  store::MeshRecord get(const std::string& id) const;                  ///< throws not_found
  std::vector<store::MeshRecord> list(const store::Page& page) const;  ///< newest first
  /// Throws not_found, not_ready (not meshed). O(m): reads the triangulation.
  std::shared_ptr<const store::BlockSource> read(const std::string& id) const;

  /// Has the operators made in the background, as creating does; with `pin` they are kept in memory
  /// until evicted. Returns at once. Throws not_found, busy, the mesh's error if it failed.
  store::MeshRecord warm(const std::string& id, bool pin);
  /// Frees the operators; the definition and the triangulation stay. Does nothing if there is none.
  /// Throws not_found, in_use (a running job or a factorisation holds them).
  store::MeshRecord evict(const std::string& id);
  /// Throws not_found, in_use (being prepared, or a job that has not ended uses it).
  void erase(const std::string& id);
  /// A job that has not ended uses the mesh: erase() refuses until the last of them lets go. Throws
  /// not_found.
  std::shared_ptr<void> use(const std::string& id);

  /// Meshes and factorises if need be, and returns the pinned operator. Blocks; `listener` hears of
  /// each phase on the calling thread. Throws the mesh's error if it failed; busy when the memory
  /// budget is held by others; disk_full or storage when the disk did not take the mesh; cancelled
  /// on `stop`, which ends this wait alone.
  std::shared_ptr<const operators::MeshOperator> prepare(const std::string& id,
                                                         const PhaseListener& listener,
                                                         std::stop_token stop);
  /// The pinned operator when it is in memory, else null. Does not block.
  std::shared_ptr<const operators::MeshOperator> find(const std::string& id) const;
  /// True when prepare() would not block: operators in memory.
  bool ready(const std::string& id) const;

  /// meshes/size_class.hpp, by the triangles the mesh has or is expected to have.
  int size_class(const std::string& id) const;
  bool pinned(const std::string& id) const;  ///< by warm(), of whichever owner of an equal mesh
  std::uint64_t meshings() const noexcept;   ///< runs of the helper so far
  int pending() const;                       ///< meshes waiting for the mesher or in it

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::meshes
