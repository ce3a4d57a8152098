// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/operator_cache.hpp"

#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "operators/cache_entries.hpp"
#include "operators/freed_memory.hpp"

namespace anticrack::operators {

using errors::Error;
using errors::Reason;
using Operator = std::shared_ptr<const MeshOperator>;
using Operators = std::vector<Operator>;

/// Guarded by the cache's mutex, except `mesh` and `stop`, which do not change.
struct Flight {
  std::shared_ptr<const mesh::Mesh> mesh;
  std::stop_source stop;
  std::jthread thread;
  std::condition_variable_any ended;
  int waiters = 0;
  bool abandoned = false;  ///< the last waiter left: it is being stopped, nobody may join
  bool done = false;
  Operator result;
  std::optional<Error> error;
};

namespace {

Error stopped() {
  return {Reason::cancelled, "stopped while waiting for the mesh's operators"};
}

/// Call without a lock: it takes as long as there are pages to be given back.
void release(Operators operators) {
  if (!operators.empty()) {
    operators.clear();
    return_freed_memory();
  }
}

}  // namespace

struct OperatorCache::State {
  State(std::uint64_t budget, Factorise factorise_mesh, Listener listener)
      : factorise(std::move(factorise_mesh)), factorised(std::move(listener)), entries(budget) {}

  const Factorise factorise;
  const Listener factorised;

  mutable std::mutex mutex;
  CacheEntries entries;
  std::vector<std::jthread> finished;  ///< threads of flights that are over, to be joined
  CacheMetrics counters;               ///< factorizations, hits and joins

  Operator hit(const std::string& key) {
    Operator ready = entries.use(key);
    counters.hits += ready ? 1 : 0;
    return ready;
  }

  /// Reserves, and starts the thread that frees what had to go and factorises.
  std::shared_ptr<Flight> take_off(const std::string& key, std::shared_ptr<const mesh::Mesh> mesh,
                                   std::uint64_t estimate) {
    auto flight = std::make_shared<Flight>();
    flight->mesh = std::move(mesh);
    Operators evicted = entries.make_room(estimate);
    entries.reserve(key, flight, estimate);
    try {
      flight->thread = std::jthread([this, key, flight, gone = std::move(evicted)]() mutable {
        release(std::move(gone));
        fly(key, *flight);
      });
    } catch (const std::system_error& error) {
      entries.erase(key);
      throw Error(Reason::busy, std::string("no thread to factorise this mesh: ") + error.what())
          .retry_after(retry_delay);
    }
    ++counters.factorizations;
    return flight;
  }

  Operator make(const Flight& flight) const {
    const auto start = std::chrono::steady_clock::now();
    Operator result = factorise(flight.mesh, flight.stop.get_token());
    if (factorised) {
      factorised(std::chrono::steady_clock::now() - start);
    }
    return result;
  }

  void fly(const std::string& key, Flight& flight) {
    Operator result;
    std::optional<Error> error;
    try {
      result = make(flight);
    } catch (const Error& thrown) {
      error = thrown;
    } catch (const std::bad_alloc&) {
      error = Error(Reason::busy, "not enough memory to factorise this mesh now");
      error->retry_after(retry_delay);
    } catch (const std::exception& thrown) {
      error = Error(Reason::internal, std::string("factorising failed: ") + thrown.what());
    }
    if (!result) {
      return_freed_memory();  // of what was stopped or failed half-way
    }
    Operators evicted;
    {
      const std::lock_guard lock(mutex);
      if (result) {
        flight.result = flight.waiters > 0 ? result : nullptr;
        evicted = entries.land(key, std::move(result));
      } else {
        entries.erase(key);
      }
      flight.error = std::move(error);
      flight.done = true;
      finished.push_back(std::move(flight.thread));
      flight.ended.notify_all();
    }
    release(std::move(evicted));
  }
};

OperatorCache::OperatorCache(std::uint64_t budget_bytes, Factorise factorise, Listener factorised)
    : _state(std::make_unique<State>(budget_bytes, std::move(factorise), std::move(factorised))) {
  set_up_heaps();
}

OperatorCache::~OperatorCache() {
  std::vector<std::jthread> threads;
  std::vector<std::stop_source> stops;
  {
    const std::lock_guard lock(_state->mutex);
    threads = std::move(_state->finished);
    for (const std::shared_ptr<Flight>& flight : _state->entries.flights()) {
      flight->abandoned = true;
      stops.push_back(flight->stop);
      threads.push_back(std::move(flight->thread));
    }
  }
  for (std::stop_source& stop : stops) {
    stop.request_stop();
  }
  threads.clear();  // joins
}

std::shared_ptr<const MeshOperator> OperatorCache::acquire(const std::string& key,
                                                           std::shared_ptr<const mesh::Mesh> mesh,
                                                           std::stop_token stop) {
  std::vector<std::jthread> finished;  // joined after the lock is released
  std::optional<std::uint64_t> estimate;
  std::shared_ptr<Flight> flight;

  std::unique_lock lock(_state->mutex);
  finished = std::exchange(_state->finished, {});
  while (!flight) {
    if (Operator ready = _state->hit(key)) {
      return ready;
    }
    if (stop.stop_requested()) {
      throw stopped();
    }
    if (const CacheEntry* found = _state->entries.find(key)) {
      const std::shared_ptr<Flight> other = found->flight;
      if (other->abandoned) {
        other->ended.wait(lock, stop, [&] { return other->done; });
        continue;
      }
      flight = other;
      ++_state->counters.joins;
    } else if (!estimate) {
      lock.unlock();
      estimate = estimate_bytes(*mesh);
      lock.lock();
    } else {
      flight = _state->take_off(key, mesh, *estimate);
    }
  }

  ++flight->waiters;
  flight->ended.wait(lock, stop, [&] { return flight->done; });
  const bool last = --flight->waiters == 0;
  if (!flight->done) {
    flight->abandoned = last;
    lock.unlock();
    if (last) {
      flight->stop.request_stop();
    }
    throw stopped();
  }
  // The flight would pin the operator as long as its thread is not joined.
  Operator result = last ? std::move(flight->result) : flight->result;
  if (!result) {
    throw Error(*flight->error);
  }
  return result;
}

std::shared_ptr<const MeshOperator> OperatorCache::find(const std::string& key) {
  const std::lock_guard lock(_state->mutex);
  return _state->hit(key);
}

bool OperatorCache::contains(const std::string& key) const {
  const std::lock_guard lock(_state->mutex);
  const CacheEntry* entry = std::as_const(_state->entries).find(key);
  return entry != nullptr && entry->ready;
}

bool OperatorCache::pin(const std::string& key) {
  const std::lock_guard lock(_state->mutex);
  CacheEntry* entry = _state->entries.find(key);
  if (entry == nullptr || !entry->ready) {
    return false;
  }
  entry->kept = true;
  return true;
}

bool OperatorCache::pinned(const std::string& key) const {
  const std::lock_guard lock(_state->mutex);
  const CacheEntry* entry = std::as_const(_state->entries).find(key);
  return entry != nullptr && entry->kept;
}

OperatorCache::Eviction OperatorCache::evict(const std::string& key) {
  Operators evicted;
  {
    const std::lock_guard lock(_state->mutex);
    if (_state->entries.find(key) == nullptr) {
      return Eviction::not_there;
    }
    evicted.push_back(_state->entries.take(key));
  }
  if (!evicted.front()) {
    return Eviction::in_use;
  }
  release(std::move(evicted));
  return Eviction::done;
}

CacheMetrics OperatorCache::metrics() const {
  const std::lock_guard lock(_state->mutex);
  CacheMetrics metrics = _state->counters;
  _state->entries.measure(metrics);
  return metrics;
}

}  // namespace anticrack::operators
