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

/// The retry delay of `busy` errors about memory or threads.
constexpr std::chrono::milliseconds retry_delay{1000};

/// Operators that nobody has asked for in this time are no longer protected by their owner's share.
constexpr std::chrono::milliseconds default_stale_after{std::chrono::hours(1)};

struct CacheMetrics {
  std::uint64_t factorizations = 0;
  std::uint64_t hits = 0;
  std::uint64_t joins = 0;  ///< callers that waited for a factorisation under way
  std::uint64_t evictions = 0;
  std::uint64_t bytes = 0;   ///< held now; operators being factorised count with their estimate
  std::uint64_t budget = 0;  ///< bytes
  std::uint64_t pinned = 0;  ///< the part of `bytes` that cannot be evicted now
  int entries = 0;           ///< meshes
};

/// 1. There is one factorisation at a time per key, on the first caller's thread; callers that join
///    get the same operator or the same error.
/// 2. An operator in use (shared_ptr) is pinned: it counts and is not evicted.
/// 3. A factorisation first reserves its estimate and evicts unpinned entries by owners' shares
///    (memory_shares.hpp). If that is not enough, it throws errors::Error: busy, or limit_exceeded
///    if the estimate exceeds the budget. Later its measured size replaces the estimate. Measured
///    and reserved bytes stay within the budget. If a measured size exceeds its estimate (an error
///    of estimate_bytes), or an operator grows in use (theta*, bases of sweeps), unpinned entries
///    are evicted at once, and nothing more is admitted until the total is within the budget.
/// 4. `pin` keeps an entry until `evict`.
/// 5. Evicted memory returns to the system before the factorisation that needed the room begins
///    (freed_memory.hpp).
/// 6. A stop of a caller that joined ends its wait. The factorisation stops when no caller waits
///    for it any more; its own caller returns when it has ended, with `cancelled` if it was
///    stopped.
/// Thread-safe. No lock is held while factorising.
class OperatorCache {
 public:
  using Factorise = std::function<std::shared_ptr<const MeshOperator>(
      std::shared_ptr<const mesh::Mesh>, std::stop_token)>;
  /// Called after each successful factorisation with its duration, without a lock, before any
  /// caller gets the operator. Must not throw.
  using Listener = std::function<void(std::chrono::duration<double>)>;

  /// `factorise` may throw errors for acquire() and should obey its stop.
  OperatorCache(std::uint64_t budget_bytes, Factorise factorise, Listener factorised = {},
                std::chrono::milliseconds stale_after = default_stale_after);
  /// No other thread may be in a call.
  ~OperatorCache();

  /// The operator of a mesh, from memory or factorised; blocks. `key`: hash of the mesh's content;
  /// `owner`: in whose share it counts, empty without authentication.
  std::shared_ptr<const MeshOperator> acquire(const std::string& key,
                                              std::shared_ptr<const mesh::Mesh> mesh,
                                              std::stop_token stop, const std::string& owner = {});
  /// The operator when it is in memory (a hit), else null. Does not block.
  std::shared_ptr<const MeshOperator> find(const std::string& key, const std::string& owner = {});
  bool contains(const std::string& key) const;
  /// Pins an entry that is in memory; returns false if it is not there.
  bool pin(const std::string& key);
  bool pinned(const std::string& key) const;  ///< whether pin() keeps it
  enum class Eviction { done, not_there, in_use };
  /// Drops an entry, also one kept by `pin`, unless it is in use or being factorised.
  Eviction evict(const std::string& key);
  /// Counts a caller that waits for the acquire() of another caller, without calling it.
  void count_join();
  std::uint64_t budget() const noexcept;  ///< bytes
  CacheMetrics metrics() const;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::operators
