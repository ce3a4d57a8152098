// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/operator_cache.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "operators/freed_memory.hpp"
#include "operators/memory_shares.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

using errors::Error;
using errors::Reason;
using Operator = std::shared_ptr<const MeshOperator>;
using Operators = std::vector<Operator>;
using Clock = std::chrono::steady_clock;

/// A factorisation that is running, and its waiters.
struct Flight {
  std::stop_source stop;
  int waiters = 1;         ///< including the caller whose thread factorises
  bool abandoned = false;  ///< the last waiter left, so it is being stopped: too late to join
  bool done = false;
  bool starved = false;  ///< the system had no memory for it
  Operator result;
  std::optional<Error> error;
};

/// Holds either an operator or a flight.
struct Entry {
  Operator ready;
  std::shared_ptr<Flight> flight;
  std::uint64_t estimate = 0;      ///< counts during the flight; then the operator is measured
  std::set<std::string> owners{};  ///< all who asked for it
  std::uint64_t last_use = 0;
  Clock::time_point used{};
  bool kept = false;  ///< pinned by pin()

  /// Needs the mutex: then nobody can copy the operator, so use_count() is exact.
  bool in_use() const { return !ready || ready.use_count() > 1; }
  bool pinned() const { return kept || in_use(); }
  /// Measured at each call, as an operator grows by data of Algorithm 2 and by bases of sweeps.
  std::uint64_t bytes() const { return ready ? ready->bytes() : estimate; }
};

Error stopped() { return {Reason::cancelled, "stopped while waiting for the mesh's operators"}; }

std::string mebibytes(std::uint64_t bytes) {
  return fmt::format("{} MiB", (bytes + (1U << 20U) - 1) >> 20U);
}

Error too_large(std::uint64_t estimate, std::uint64_t budget) {
  return {Reason::limit_exceeded,
          "the operators of this mesh need about " + mebibytes(estimate) +
              ", more than the memory budget of " + mebibytes(budget) +
              ": use a coarser mesh (larger size or tip_size) or a server with a larger budget"};
}

Error full(std::uint64_t estimate, std::uint64_t held, std::uint64_t budget) {
  Error error(Reason::busy, "the operators of this mesh need about " + mebibytes(estimate) +
                                "; running jobs, factorisations and pinned meshes hold " +
                                mebibytes(held) + " of the memory budget of " + mebibytes(budget) +
                                ": try again when one has ended");
  return error.retry_after(retry_delay);
}

Error over_share(std::uint64_t estimate, const PinnedShare& share) {
  Error error(Reason::busy, "the operators of this mesh need about " + mebibytes(estimate) +
                                "; your running jobs and factorisations hold " +
                                mebibytes(share.own) + ", those of one user may hold " +
                                mebibytes(share.most) + " now: try again when one has ended");
  return error.retry_after(retry_delay);
}

/// Frees the operators and returns their pages, which may be slow; call it without a lock.
void release(Operators operators) {
  if (!operators.empty()) {
    operators.clear();
    return_freed_memory();
  }
}

}  // namespace

/// The mutex guards everything but the constants. Evicted operators are freed without it.
struct OperatorCache::State {
  using Lock = std::unique_lock<std::mutex>;

  State(std::uint64_t budget_bytes, Factorise factorise_mesh, Listener listener,
        std::chrono::milliseconds stale)
      : budget(budget_bytes),
        factorise(std::move(factorise_mesh)),
        factorised(std::move(listener)),
        stale_after(stale) {}

  const std::uint64_t budget;
  const Factorise factorise;
  const Listener factorised;
  const std::chrono::milliseconds stale_after;

  std::mutex mutex;
  std::condition_variable_any landed;
  std::unordered_map<std::string, Entry> entries;
  std::uint64_t clock = 0;
  CacheMetrics counters;  ///< factorizations, hits, joins and evictions

  Entry* find(const std::string& key) {
    const auto found = entries.find(key);
    return found == entries.end() ? nullptr : &found->second;
  }

  void use(Entry& entry, const std::string& owner) {
    entry.owners.insert(owner);
    entry.last_use = ++clock;
    entry.used = Clock::now();
  }

  Operator hit(const std::string& key, const std::string& owner) {
    Entry* entry = find(key);
    if (entry == nullptr || !entry->ready) return nullptr;
    use(*entry, owner);
    ++counters.hits;
    return entry->ready;
  }

  std::uint64_t pinned_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [key, entry] : entries) bytes += entry.pinned() ? entry.bytes() : 0;
    return bytes;
  }

  /// Takes out an operator; null if it is in use.
  Operator take(const std::string& key) {
    Entry* entry = find(key);
    if (entry == nullptr || entry->in_use()) return nullptr;
    Operator taken = std::move(entry->ready);
    entries.erase(key);
    ++counters.evictions;
    return taken;
  }

  std::vector<Resident> residents() const {
    const Clock::time_point stale = Clock::now() - stale_after;
    std::vector<Resident> all;
    for (const auto& [key, entry] : entries)
      all.push_back({&key, &entry.owners, entry.bytes(), entry.last_use, entry.used < stale,
                     entry.in_use(), entry.kept});
    return all;
  }

  /// Takes out operators until the rest and `wanted` fit in `limit`, as choose_victims() says.
  std::optional<Operators> evict(const std::string& owner, std::uint64_t wanted,
                                 std::uint64_t limit) {
    const auto chosen = choose_victims(residents(), owner, wanted, limit);
    if (!chosen) return std::nullopt;
    Operators evicted;
    for (const std::string& key : *chosen) evicted.push_back(take(key));
    return evicted;
  }

  /// Evicts to make room for a factorisation. Throws errors::Error (limit_exceeded, busy).
  Operators make_room(const std::string& owner, std::uint64_t estimate) {
    if (estimate > budget) throw too_large(estimate, budget);
    const PinnedShare share = pinned_share(residents(), owner, estimate, budget);
    const bool fits = estimate <= budget - std::min(budget, share.used);
    if (fits && !share.enough) throw over_share(estimate, share);
    std::optional<Operators> evicted = fits ? evict(owner, estimate, budget) : std::nullopt;
    if (!evicted) throw full(estimate, share.used, budget);
    return std::move(*evicted);
  }

  /// Removes a waiter; the last one stops the factorisation, without holding the lock.
  void leave(Lock& lock, Flight& flight) {
    flight.abandoned = --flight.waiters == 0 && !flight.done;
    if (flight.abandoned) {
      lock.unlock();
      flight.stop.request_stop();
      lock.lock();
    }
  }

  Operator join(Lock& lock, const std::shared_ptr<Flight>& flight, const std::stop_token& stop) {
    ++counters.joins;
    ++flight->waiters;
    landed.wait(lock, stop, [&] { return flight->done; });
    const bool done = flight->done;
    leave(lock, *flight);
    if (!done) throw stopped();
    // A copy in the flight would pin the operator.
    Operator result = flight->waiters == 0 ? std::move(flight->result) : flight->result;
    if (!result) throw Error(*flight->error);
    return result;
  }

  Operator make(std::shared_ptr<const mesh::Mesh> mesh, Flight& flight) const {
    try {
      const auto start = std::chrono::steady_clock::now();
      Operator result = factorise(std::move(mesh), flight.stop.get_token());
      if (factorised) factorised(std::chrono::steady_clock::now() - start);
      return result;
    } catch (const Error& thrown) {
      flight.error = thrown;
    } catch (const std::bad_alloc&) {
      flight.error = Error(Reason::busy, "not enough memory to factorise this mesh now");
      flight.error->retry_after(retry_delay);
      flight.starved = true;
    } catch (const std::exception& thrown) {
      flight.error = Error(Reason::internal, "factorising failed: {}", thrown.what());
    }
    return_freed_memory();  // of a factorisation that stopped or failed
    return nullptr;
  }

  /// The system has less memory than the budget, so all operators that are not in use go. If there
  /// are none and none is pinned, another try would fail too, and the flight gets an error.
  Operators after_starving(Flight& flight) {
    Operators evicted = evict({}, 0, pinned_bytes()).value_or(Operators());
    if (evicted.empty() && pinned_bytes() == 0) {
      flight.error = Error(Reason::limit_exceeded,
                           "there is not enough memory for the operators of this mesh, though the "
                           "memory budget of {} has room: use a coarser mesh, or give the server "
                           "more memory (ulimit -v, its control group)",
                           mebibytes(budget));
    }
    return evicted;
  }

  /// Factorises on this thread, also for callers that join.
  Operator fly(Lock& lock, const std::string& key, std::shared_ptr<const mesh::Mesh> mesh,
               const std::string& owner, std::uint64_t estimate, const std::stop_token& stop) {
    Operators evicted = make_room(owner, estimate);
    const auto flight = std::make_shared<Flight>();
    entries[key] = {nullptr, flight, estimate, {owner}};
    ++counters.factorizations;
    lock.unlock();
    release(std::exchange(evicted, {}));
    Operator result;
    bool left = false;
    {
      const std::stop_callback leaves(stop, [&] {
        Lock own(mutex);
        left = true;
        leave(own, *flight);
      });
      result = make(std::move(mesh), *flight);
    }
    lock.lock();
    flight->done = true;
    flight->waiters -= left ? 0 : 1;
    if (result) {
      flight->result = flight->waiters > 0 ? result : nullptr;
      Entry& entry = entries.at(key);
      entry.ready = result;
      entry.flight.reset();
      use(entry, owner);
      if (left) result.reset();
      // Evict until the budget is met, or as nearly as the operators in use allow.
      if (auto over = evict(owner, 0, std::max(budget, pinned_bytes()))) evicted = std::move(*over);
    } else {
      entries.erase(key);
      if (flight->starved) evicted = after_starving(*flight);
    }
    landed.notify_all();
    lock.unlock();
    release(std::move(evicted));
    if (left) throw stopped();
    if (!result) throw Error(*flight->error);
    return result;
  }
};

OperatorCache::OperatorCache(std::uint64_t budget_bytes, Factorise factorise, Listener factorised,
                             std::chrono::milliseconds stale_after)
    : _state(std::make_unique<State>(budget_bytes, std::move(factorise), std::move(factorised),
                                     stale_after)) {
  set_up_heaps();
}

OperatorCache::~OperatorCache() = default;

std::shared_ptr<const MeshOperator> OperatorCache::acquire(const std::string& key,
                                                           std::shared_ptr<const mesh::Mesh> mesh,
                                                           std::stop_token stop,
                                                           const std::string& owner) {
  std::optional<std::uint64_t> estimate;
  State::Lock lock(_state->mutex);
  for (;;) {
    if (Operator ready = _state->hit(key, owner)) return ready;
    if (stop.stop_requested()) throw stopped();
    if (Entry* found = _state->find(key)) {
      const std::shared_ptr<Flight> flight = found->flight;
      found->owners.insert(owner);
      if (!flight->abandoned) return _state->join(lock, flight, stop);
      _state->landed.wait(lock, stop, [&] { return flight->done; });
    } else if (estimate) {
      return _state->fly(lock, key, std::move(mesh), owner, *estimate, stop);
    } else {
      lock.unlock();
      {
        const stop::Scope scope(stop);
        estimate = estimate_bytes(*mesh);
      }
      lock.lock();
    }
  }
}

std::shared_ptr<const MeshOperator> OperatorCache::find(const std::string& key,
                                                        const std::string& owner) {
  const std::lock_guard lock(_state->mutex);
  return _state->hit(key, owner);
}

bool OperatorCache::contains(const std::string& key) const {
  const std::lock_guard lock(_state->mutex);
  const Entry* entry = _state->find(key);
  return entry != nullptr && entry->ready;
}

bool OperatorCache::pin(const std::string& key) {
  const std::lock_guard lock(_state->mutex);
  Entry* entry = _state->find(key);
  if (entry == nullptr || !entry->ready) return false;
  entry->kept = true;
  return true;
}

bool OperatorCache::pinned(const std::string& key) const {
  const std::lock_guard lock(_state->mutex);
  const Entry* entry = _state->find(key);
  return entry != nullptr && entry->kept;
}

OperatorCache::Eviction OperatorCache::evict(const std::string& key) {
  Operators evicted;
  {
    const std::lock_guard lock(_state->mutex);
    if (_state->find(key) == nullptr) return Eviction::not_there;
    evicted.push_back(_state->take(key));
  }
  if (!evicted.front()) return Eviction::in_use;
  release(std::move(evicted));
  return Eviction::done;
}

void OperatorCache::count_join() {
  const std::lock_guard lock(_state->mutex);
  ++_state->counters.joins;
}

std::uint64_t OperatorCache::budget() const noexcept { return _state->budget; }

CacheMetrics OperatorCache::metrics() const {
  const std::lock_guard lock(_state->mutex);
  CacheMetrics metrics = _state->counters;
  for (const auto& [key, entry] : _state->entries) metrics.bytes += entry.bytes();
  metrics.budget = _state->budget;
  metrics.pinned = _state->pinned_bytes();
  metrics.entries = static_cast<int>(_state->entries.size());
  return metrics;
}

}  // namespace anticrack::operators
