// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/cache_entries.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "errors/errors.hpp"
#include "operators/eviction.hpp"

namespace anticrack::operators {

namespace {

using errors::Error;
using errors::Reason;

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1U << 20U) - 1) >> 20U) + " MiB";
}

Error too_large(std::uint64_t estimate, std::uint64_t budget) {
  return {Reason::limit_exceeded, "the operators of this mesh need about " + mebibytes(estimate) +
                                      ", more than the memory budget of " + mebibytes(budget) +
                                      ": use a coarser mesh or a server with a larger budget"};
}

Error full(std::uint64_t estimate, std::uint64_t held, std::uint64_t budget) {
  Error error(Reason::busy, "the operators of this mesh need about " + mebibytes(estimate) +
                                "; running jobs, factorisations and pinned meshes hold " +
                                mebibytes(held) + " of the memory budget of " + mebibytes(budget) +
                                ": try again when one has ended");
  return error.retry_after(retry_delay);
}

bool pinned(const CacheEntry& entry) {
  return entry.kept || entry.in_use();
}

/// An operator grows: by what Algorithm 2 alone needs, and by bases of sweeps.
std::uint64_t bytes_of(const CacheEntry& entry) {
  return entry.ready ? entry.ready->bytes() : entry.estimate;
}

}  // namespace

CacheEntry* CacheEntries::find(const std::string& key) {
  const auto found = _entries.find(key);
  return found == _entries.end() ? nullptr : &found->second;
}

const CacheEntry* CacheEntries::find(const std::string& key) const {
  const auto found = _entries.find(key);
  return found == _entries.end() ? nullptr : &found->second;
}

CacheEntries::Operator CacheEntries::use(const std::string& key) {
  CacheEntry* entry = find(key);
  if (entry == nullptr || !entry->ready) {
    return nullptr;
  }
  entry->last_use = ++_clock;
  return entry->ready;
}

void CacheEntries::reserve(const std::string& key, std::shared_ptr<Flight> flight,
                           std::uint64_t estimate) {
  CacheEntry& entry = _entries[key];
  entry.flight = std::move(flight);
  entry.estimate = estimate;
}

std::vector<CacheEntries::Operator> CacheEntries::land(const std::string& key, Operator result) {
  CacheEntry& entry = _entries.at(key);
  entry.ready = std::move(result);
  entry.flight.reset();
  entry.last_use = ++_clock;
  std::vector<Operator> evicted;
  // As near to the budget as those in use allow.
  evict(0, std::max(_budget, pinned_bytes()), evicted);
  return evicted;
}

std::vector<std::shared_ptr<Flight>> CacheEntries::flights() const {
  std::vector<std::shared_ptr<Flight>> flights;
  for (const auto& [key, entry] : _entries) {
    if (entry.flight) {
      flights.push_back(entry.flight);
    }
  }
  return flights;
}

std::vector<CacheEntries::Operator> CacheEntries::make_room(std::uint64_t estimate) {
  std::vector<Operator> evicted;
  if (!evict(estimate, _budget, evicted)) {
    throw estimate > _budget ? too_large(estimate, _budget)
                             : full(estimate, pinned_bytes(), _budget);
  }
  return evicted;
}

CacheEntries::Operator CacheEntries::take(const std::string& key) {
  const auto found = _entries.find(key);
  if (found == _entries.end() || found->second.in_use()) {
    return nullptr;
  }
  Operator taken = std::move(found->second.ready);
  _entries.erase(found);
  ++_evictions;
  return taken;
}

void CacheEntries::measure(CacheMetrics& metrics) const {
  metrics.bytes = 0;
  for (const auto& [key, entry] : _entries) {
    metrics.bytes += bytes_of(entry);
  }
  metrics.budget = _budget;
  metrics.pinned = pinned_bytes();
  metrics.entries = static_cast<int>(_entries.size());
  metrics.evictions = _evictions;
}

std::uint64_t CacheEntries::pinned_bytes() const {
  std::uint64_t bytes = 0;
  for (const auto& [key, entry] : _entries) {
    bytes += pinned(entry) ? bytes_of(entry) : 0;
  }
  return bytes;
}

bool CacheEntries::evict(std::uint64_t wanted, std::uint64_t budget,
                         std::vector<Operator>& evicted) {
  std::vector<Candidate> candidates;
  std::vector<std::string> keys;
  for (const auto& [key, entry] : _entries) {
    candidates.push_back({bytes_of(entry), entry.last_use, pinned(entry)});
    keys.push_back(key);
  }
  const auto chosen = evictions(candidates, wanted, budget);
  if (!chosen) return false;
  for (const std::size_t index : *chosen) evicted.push_back(take(keys[index]));
  return true;
}

}  // namespace anticrack::operators
