// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the operator cache holds, and the account of its bytes. Not thread-safe: guarded by the
// cache's mutex.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "operators/mesh_operator.hpp"
#include "operators/operator_cache.hpp"

namespace anticrack::operators {

/// One factorisation and those who wait for it (operator_cache.cpp).
struct Flight;

/// Either an operator or a flight.
struct CacheEntry {
  std::shared_ptr<const MeshOperator> ready;
  std::shared_ptr<Flight> flight;
  std::uint64_t estimate = 0;  ///< counts in flight; an operator is measured
  std::uint64_t last_use = 0;
  bool kept = false;  ///< pinned without a holder

  /// With the mutex held nobody can get at the operator but through a copy that counts already.
  bool in_use() const { return !ready || ready.use_count() > 1; }
};

class CacheEntries {
 public:
  using Operator = std::shared_ptr<const MeshOperator>;

  explicit CacheEntries(std::uint64_t budget) : _budget(budget) {}

  /// Null where there is none; does not count as a use.
  CacheEntry* find(const std::string& key);
  const CacheEntry* find(const std::string& key) const;
  /// Null unless it is in memory; else used now.
  Operator use(const std::string& key);
  /// A flight for which make_room was called.
  void reserve(const std::string& key, std::shared_ptr<Flight> flight, std::uint64_t estimate);
  /// The flight of `key` has ended with this operator. Returns what has to go where it is more than
  /// was reserved.
  std::vector<Operator> land(const std::string& key, Operator result);
  void erase(const std::string& key) { _entries.erase(key); }
  /// The flights under way.
  std::vector<std::shared_ptr<Flight>> flights() const;

  // What these return is out of the account; the caller frees it, without the mutex.
  /// Takes out what has to go for `estimate` more bytes, least recently used first. Throws
  /// errors::Error (busy, or limit_exceeded where it could never fit), and nothing has gone.
  std::vector<Operator> make_room(std::uint64_t estimate);
  /// Takes out one that is in memory and nobody holds; null otherwise.
  Operator take(const std::string& key);

  /// bytes, budget, pinned, entries and evictions; the rest is left alone.
  void measure(CacheMetrics& metrics) const;

 private:
  std::uint64_t pinned_bytes() const;
  /// Least recently used first, until the rest and `wanted` are within `budget`. False, and nothing
  /// has gone, where that cannot be.
  bool evict(std::uint64_t wanted, std::uint64_t budget, std::vector<Operator>& evicted);

  const std::uint64_t _budget;
  std::unordered_map<std::string, CacheEntry> _entries;
  std::uint64_t _clock = 0;
  std::uint64_t _evictions = 0;
};

}  // namespace anticrack::operators
