// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <unordered_map>
#include <vector>

#include "contact/sweep_solver.hpp"
#include "ddm/subdomain_operator.hpp"
#include "fem/load.hpp"
#include "operators/condense_loads.hpp"
#include "operators/load_bounds.hpp"
#include "operators/working.hpp"

namespace anticrack::operators {

struct RowTips;
struct SharedBounds;

/// Loads of one mesh, condensed and reduced for the rows of a sweep. Does not keep the mesh.
struct CondensedBasis {
  contact::SweepLoads reduced;
  std::vector<LoadOnTraces> loads;          ///< no z_boundary, parts; z_interior if joined, bounded
  std::vector<ddm::LoadProducts> products;  ///< per subdomain
  std::vector<BalancedLoad> balanced;       ///< per load; empty: rows have no bounds
  std::shared_ptr<const SharedBounds> shared;  ///< null: rows with bounds are bounded one by one
  std::shared_ptr<const RowTips> tips;         ///< null: rows have no numbers of tips
  std::vector<std::string> warnings;           ///< of all loads, without repetition
  std::unique_ptr<const Working> counted;      ///< its bytes, also while only a job has it

  /// Memory of the arrays in bytes.
  std::size_t bytes() const noexcept;
};

/// What a basis is made for.
enum class Bounds : char { none = '-', own = 'b', shared = 's' };

/// Key of a list of loads and what they are condensed for. Two keys are equal if and only if all
/// fields of the loads but their names are; the hash of its upload stands for an array. None if an
/// array has no hash.
std::optional<std::string> key_of(std::span<const fem::Load* const> loads,
                                  Bounds bounds = Bounds::none, bool tips = false);

/// The most recently used bases of one mesh, at most 8 and, with their keys, 64 MiB. The least
/// recently used one is dropped first; a basis above the limit alone is not kept. Thread-safe; no
/// lock is held while a basis is made.
class BasisCache {
 public:
  using Basis = std::shared_ptr<const CondensedBasis>;
  static constexpr std::size_t most_bases = 8;
  static constexpr std::size_t most_bytes = std::size_t{64} << 20;

  /// The basis of `key`, made if missing. Of concurrent callers the first makes it and the others
  /// get the same basis or error; if the maker is stopped, the next caller makes it. Throws what
  /// `make` throws, and errors::Error (cancelled) when stopped while waiting.
  Basis get(const std::string& key, const std::stop_token& stop,
            const std::function<Basis()>& make);

  /// The memory of the bases kept.
  std::size_t bytes() const noexcept { return _bytes; }

 private:
  struct Flight;
  struct Entry {
    std::string key;
    Basis basis;
    std::size_t bytes = 0;
  };
  using Entries = std::list<Entry>;

  void keep(const std::string& key, const Basis& basis, Entries& evicted);

  std::mutex _mutex;
  std::condition_variable_any _landed;
  Entries _entries;  // the last used first; so few that a linear search is fast
  std::unordered_map<std::string, std::shared_ptr<Flight>> _flights;
  std::atomic<std::size_t> _bytes{0};
};

}  // namespace anticrack::operators
