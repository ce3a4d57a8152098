// SPDX-License-Identifier: GPL-3.0-or-later
//
// The server's meshes: from a definition to a triangulation (by the helper process) to factorised
// operators (in the cache).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "mesher/helper.hpp"
#include "meshes/mesh_waits.hpp"
#include "operators/operator_cache.hpp"
#include "store/store.hpp"

namespace anticrack::meshes {

struct CatalogueOptions {
  mesher::HelperOptions helper;
  std::size_t max_triangles = 4'000'000;
  std::size_t max_pending = 64;     ///< most meshes that wait for the mesher; above: `busy`
  std::size_t max_meshes = 10'000;  ///< most records; above: quota_exceeded
  std::size_t max_expression_bytes = 4096;
  /// Called without a lock for each mesh that the helper made or failed to make. Must not throw.
  std::function<void(const records::MeshRecord&)> meshed = {};
};

/// Meshes and factorises new meshes in the background, in the order of queue.hpp; MeshWaits
/// hands them to those who need them. Thread-safe.
///
/// On disk a mesh is PENDING, EVICTED (meshed) or FAILED. At start, meshes that are still PENDING
/// are scheduled, oldest first, except those that only jobs want. A mesh for which the disk has no
/// room stays PENDING; its waiters get the error, and it is tried again until there is room.
class MeshCatalogue {
 public:
  /// Schedules the pending meshes of the store. `store` and `cache` must outlive the catalogue.
  MeshCatalogue(CatalogueOptions options, store::Store& store, operators::OperatorCache& cache);
  /// Stops running preparations (kills the helper).
  ~MeshCatalogue();

  /// Returns the record of an equal definition, or writes and returns a new, pending one. A failed
  /// mesh is tried again. Does not wait for the mesher. Owners share triangulations and operators
  /// of equal meshes, but not records. `for_job`: only jobs want the mesh; its preparation stops
  /// when the last of them has ended. Throws errors::Error: geometry_invalid, invalid_argument,
  /// not_found (upload), busy, quota_exceeded, disk_full.
  records::MeshRecord create(const records::MeshDefinition& definition, const std::string& title,
                             const std::string& owner, bool for_job = false);

  struct Parent {
    std::string mesh;  ///< id
    std::string job;   ///< id of the job that refines it
    std::string owner;
  };
  /// Bisects the triangles of a mesh; levels (m) as for mesh::refine(). The new mesh is made and
  /// written at once, its operators later, in the background. The same parent and levels give the
  /// same mesh. Throws errors::Error: not_found, not_ready (the parent), limit_exceeded (too many
  /// triangles, or at "memory_budget" too much memory for its operators), quota_exceeded,
  /// disk_full, numerical (the triangles to bisect are as small as mesh::refine() makes them),
  /// cancelled at a look (stop/stop.hpp).
  records::MeshRecord refine(const Parent& parent, std::span<const std::uint8_t> levels,
                             std::size_t max_triangles);
  std::size_t max_triangles() const noexcept;  ///< most triangles of a mesh
  struct Passing {
    std::string name;  ///< of this mesh alone
    std::string owner;
    std::uint64_t held = 0;  ///< bytes of operators that the caller keeps meanwhile
  };
  /// The operators of a mesh that has no record, within the memory budget; they are evicted with
  /// the last pointer to them. Waits half a minute while others use the memory. Throws
  /// errors::Error: limit_exceeded (too large for the budget), busy, numerical, cancelled.
  std::shared_ptr<const operators::MeshOperator> operators_of(
      const Passing& passing, std::shared_ptr<const mesh::Mesh> mesh, const std::stop_token& stop);

  records::MeshRecord get(const std::string& id) const;                  ///< throws not_found
  std::vector<records::MeshRecord> list(const store::Page& page) const;  ///< newest first
  /// Throws not_found, not_ready (not meshed). O(m): reads the triangulation.
  std::shared_ptr<const records::BlockSource> read(const std::string& id) const;

  /// Prepares the operators in the background, as create() does; `pin` keeps them in memory until
  /// evict(). Returns at once. Throws not_found, busy, the error of a failed mesh.
  records::MeshRecord warm(const std::string& id, bool pin);
  /// Frees the operators, if any; the definition and the triangulation stay. Throws not_found,
  /// in_use (a running job or a factorisation needs them).
  records::MeshRecord evict(const std::string& id);
  /// Stops the preparation and deletes the mesh. Throws not_found, in_use (an unfinished job uses
  /// it).
  void erase(const std::string& id);
  /// Marks the mesh as used by an unfinished job: erase() refuses until all pointers returned here
  /// are released. Then the preparation stops if only jobs wanted the mesh. Throws not_found.
  std::shared_ptr<void> use(const std::string& id);

  /// Whether the operators are in memory.
  bool ready(const std::string& id) const;

  /// The meshes whose operators are in memory. O(meshes).
  std::vector<std::string> in_memory() const;

  bool pinned(const std::string& id) const;  ///< by warm(), for any owner of an equal mesh
  std::uint64_t meshings() const noexcept;   ///< runs of the helper so far
  int pending() const;                       ///< meshes that wait for the mesher or are in it

 private:
  friend class MeshWaits;
  /// The triangulation of a mesh. Throws as read().
  std::shared_ptr<const mesh::Mesh> triangulation(const std::string& id) const;

  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::meshes
