// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/operator_cache.hpp"

#include <condition_variable>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "operators/eviction.hpp"

namespace anticrack::operators {

namespace {

using errors::Error;
using errors::Reason;
using Operator = std::shared_ptr<const MeshOperator>;

constexpr std::chrono::milliseconds retry_delay{1000};

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1U << 20U) - 1) >> 20U) + " MiB";
}

Error stopped() {
  return {Reason::cancelled, "stopped while waiting for the mesh's operators"};
}

Error too_large(std::uint64_t estimate, std::uint64_t budget) {
  return {Reason::limit_exceeded, "the operators of this mesh need about " + mebibytes(estimate) +
                                      ", more than the memory budget of " + mebibytes(budget) +
                                      ": use a coarser mesh or a server with a larger budget"};
}

Error full(std::uint64_t estimate, std::uint64_t held, std::uint64_t budget) {
  Error error(Reason::busy, "the operators of this mesh need about " + mebibytes(estimate) +
                                "; running jobs and factorisations hold " + mebibytes(held) +
                                " of the memory budget of " + mebibytes(budget) +
                                ": try again when one has ended");
  return error.retry_after(retry_delay);
}

/// One factorisation and those who wait for it. Guarded by the cache's mutex, except `mesh` and
/// `stop`, which do not change.
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

/// Either an operator or a flight.
struct Entry {
  Operator ready;
  std::shared_ptr<Flight> flight;
  std::uint64_t bytes = 0;  ///< measured, or the estimate while in flight
  std::uint64_t last_use = 0;

  /// With the mutex held nobody can get at the operator but through a copy that counts already.
  bool pinned() const { return !ready || ready.use_count() > 1; }
};

}  // namespace

struct OperatorCache::State {
  State(std::uint64_t budget_bytes, Factorise factorise_mesh)
      : budget(budget_bytes), factorise(std::move(factorise_mesh)) {}

  const std::uint64_t budget;
  const Factorise factorise;

  mutable std::mutex mutex;
  using Entries = std::unordered_map<std::string, Entry>;
  Entries entries;
  std::vector<std::jthread> finished;  ///< threads of flights that are over, to be joined
  std::uint64_t clock = 0;
  CacheMetrics counters;  ///< but `bytes`

  std::uint64_t held() const {
    std::uint64_t sum = 0;
    for (const auto& [key, entry] : entries) {
      sum += entry.bytes;
    }
    return sum;
  }

  Operator hit(Entries::iterator found) {
    if (found == entries.end() || !found->second.ready) {
      return nullptr;
    }
    ++counters.hits;
    found->second.last_use = ++clock;
    return found->second.ready;
  }

  /// Removes what has to go for `estimate` more bytes; the operators themselves are freed by the
  /// caller, without the lock.
  std::vector<Operator> make_room(std::uint64_t estimate) {
    std::vector<Candidate> candidates;
    std::vector<std::string> keys;
    std::uint64_t pinned_bytes = 0;
    for (const auto& [key, entry] : entries) {
      candidates.push_back({entry.bytes, entry.last_use, entry.pinned()});
      keys.push_back(key);
      pinned_bytes += entry.pinned() ? entry.bytes : 0;
    }
    const auto chosen = evictions(candidates, estimate, budget);
    if (!chosen) {
      throw estimate > budget ? too_large(estimate, budget) : full(estimate, pinned_bytes, budget);
    }
    std::vector<Operator> evicted;
    for (const std::size_t index : *chosen) {
      const auto entry = entries.find(keys[index]);
      evicted.push_back(std::move(entry->second.ready));
      entries.erase(entry);
      ++counters.evictions;
    }
    return evicted;
  }

  std::shared_ptr<Flight> take_off(const std::string& key, std::shared_ptr<const mesh::Mesh> mesh,
                                   std::uint64_t estimate) {
    auto flight = std::make_shared<Flight>();
    flight->mesh = std::move(mesh);
    Entry& entry = entries[key];
    entry.flight = flight;
    entry.bytes = estimate;
    try {
      flight->thread = std::jthread([this, key, flight] { fly(key, *flight); });
    } catch (const std::system_error& error) {
      entries.erase(key);
      throw Error(Reason::busy, std::string("no thread to factorise this mesh: ") + error.what())
          .retry_after(retry_delay);
    }
    ++counters.factorizations;
    return flight;
  }

  void fly(const std::string& key, Flight& flight) {
    Operator result;
    std::optional<Error> error;
    try {
      result = factorise(flight.mesh, flight.stop.get_token());
    } catch (const Error& thrown) {
      error = thrown;
    } catch (const std::bad_alloc&) {
      error = Error(Reason::busy, "not enough memory to factorise this mesh now");
      error->retry_after(retry_delay);
    } catch (const std::exception& thrown) {
      error = Error(Reason::internal, std::string("factorising failed: ") + thrown.what());
    }
    const std::lock_guard lock(mutex);
    if (result) {
      Entry& entry = entries.at(key);
      entry.bytes = result->bytes();
      entry.last_use = ++clock;
      entry.flight.reset();
      entry.ready = flight.waiters > 0 ? result : std::move(result);
    } else {
      entries.erase(key);
    }
    flight.result = std::move(result);
    flight.error = std::move(error);
    flight.done = true;
    finished.push_back(std::move(flight.thread));
    flight.ended.notify_all();
  }
};

OperatorCache::OperatorCache(std::uint64_t budget_bytes, Factorise factorise)
    : _state(std::make_unique<State>(budget_bytes, std::move(factorise))) {}

OperatorCache::~OperatorCache() {
  std::vector<std::jthread> threads;
  std::vector<std::stop_source> stops;
  {
    const std::lock_guard lock(_state->mutex);
    threads = std::move(_state->finished);
    for (auto& [key, entry] : _state->entries) {
      if (entry.flight) {
        entry.flight->abandoned = true;
        stops.push_back(entry.flight->stop);
        threads.push_back(std::move(entry.flight->thread));
      }
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
  // Both are destroyed after the lock is released: joining and freeing take time.
  std::vector<std::jthread> finished;
  std::vector<Operator> evicted;
  std::optional<std::uint64_t> estimate;
  std::shared_ptr<Flight> flight;

  std::unique_lock lock(_state->mutex);
  finished = std::exchange(_state->finished, {});
  while (!flight) {
    const auto found = _state->entries.find(key);
    if (Operator ready = _state->hit(found)) {
      return ready;
    }
    if (stop.stop_requested()) {
      throw stopped();
    }
    if (found != _state->entries.end()) {
      const std::shared_ptr<Flight> other = found->second.flight;
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
      evicted = _state->make_room(*estimate);
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
  return _state->hit(_state->entries.find(key));
}

bool OperatorCache::contains(const std::string& key) const {
  const std::lock_guard lock(_state->mutex);
  const auto found = _state->entries.find(key);
  return found != _state->entries.end() && found->second.ready;
}

bool OperatorCache::evict(const std::string& key) {
  Operator evicted;
  const std::lock_guard lock(_state->mutex);
  const auto found = _state->entries.find(key);
  if (found == _state->entries.end() || found->second.pinned()) {
    return false;
  }
  evicted = std::move(found->second.ready);
  _state->entries.erase(found);
  ++_state->counters.evictions;
  return true;
}

CacheMetrics OperatorCache::metrics() const {
  const std::lock_guard lock(_state->mutex);
  CacheMetrics metrics = _state->counters;
  metrics.bytes = _state->held();
  return metrics;
}

}  // namespace anticrack::operators
