// SPDX-License-Identifier: GPL-3.0-or-later
//
// Factorised meshes in memory, under a byte budget.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "operators/mesh_operator.hpp"

namespace anticrack::operators {

/// After which an error `busy` about memory or threads says to try again.
constexpr std::chrono::milliseconds retry_delay{1000};

struct CacheMetrics {
  std::uint64_t factorizations = 0;
  std::uint64_t hits = 0;
  std::uint64_t joins = 0;  ///< callers that waited for a factorisation under way
  std::uint64_t evictions = 0;
  std::uint64_t bytes = 0;   ///< held now, what is being factorised counted by its estimate
  std::uint64_t budget = 0;  ///< bytes
  std::uint64_t pinned = 0;  ///< of `bytes`, what cannot be evicted now
  int entries = 0;           ///< meshes
};

/// Contract:
/// 1. One factorisation at a time per key, on the thread of the first who asks for it; others that
///    ask meanwhile join and get the same operator, or the same error.
/// 2. An operator somebody still holds (shared_ptr) is pinned: it counts, and is not evicted.
/// 3. Before a factorisation its estimate is reserved: unpinned entries go, least recently used
///    first; where that is not enough: errors::Error (busy, or limit_exceeded when the estimate
///    alone is over the budget). After it the measured size replaces the estimate.
///    The budget is kept: at no moment do measured and reserved bytes together exceed it. Should a
///    measured size exceed its estimate (estimate_bytes is an upper bound: a bug in it), unpinned
///    entries go at once; what is over even then is kept for those who wait, counted as it is, and
///    nothing more is admitted until the whole is within the budget again. The same holds where an
///    operator grows in use (theta*, bases of sweeps): it counts as large as it is now.
/// 4. `pin` keeps an entry until `evict`, also without a holder.
/// 5. Evicted memory is freed before what it made room for is factorised, and goes back to the
///    system (freed_memory.hpp).
/// 6. A joiner's stop ends its wait. The factorisation is stopped when nobody wants it any more;
/// the
///    caller whose thread it is on returns when it has ended, `cancelled` where it was stopped.
/// Thread-safe. Locks are never held while factorising.
class OperatorCache {
 public:
  using Factorise = std::function<std::shared_ptr<const MeshOperator>(
      std::shared_ptr<const mesh::Mesh>, std::stop_token)>;
  /// Told of each factorisation that succeeded, without a lock and before anybody gets the
  /// operator: how long it took. Must not throw.
  using Listener = std::function<void(std::chrono::duration<double>)>;

  /// `factorise` may throw what acquire() is to throw, and should obey its stop.
  OperatorCache(std::uint64_t budget_bytes, Factorise factorise, Listener factorised = {});
  /// Nobody may be in acquire() any more.
  ~OperatorCache();

  /// The operator of a mesh, from memory or factorised. Blocks.
  /// `key` is the hash of the mesh's content.
  std::shared_ptr<const MeshOperator> acquire(const std::string& key,
                                              std::shared_ptr<const mesh::Mesh> mesh,
                                              std::stop_token stop);
  /// The operator when it is in memory (a hit), else null. Does not block.
  std::shared_ptr<const MeshOperator> find(const std::string& key);
  bool contains(const std::string& key) const;
  /// Keeps an entry that is in memory; false when it is not there.
  bool pin(const std::string& key);
  bool pinned(const std::string& key) const;  ///< by `pin`
  enum class Eviction { done, not_there, in_use };
  /// Drops an entry, a pinned one too; not one that somebody holds or that is being factorised.
  Eviction evict(const std::string& key);
  /// Somebody waits for what another caller of acquire() waits for, without calling it as well.
  void count_join();
  CacheMetrics metrics() const;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::operators
