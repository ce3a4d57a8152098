// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whose operators go when memory is needed: the policy, without threads or locks.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace anticrack::operators {

/// Operators in memory, or being made.
struct Resident {
  const std::string* key = nullptr;
  const std::set<std::string>* owners = nullptr;  ///< all who asked for them; at least one
  std::uint64_t bytes = 0;
  std::uint64_t last_use = 0;  ///< larger: later
  bool stale = false;          ///< not used for long
  bool in_use = false;         ///< by a job or a factorisation: until that ends
  bool kept = false;           ///< until somebody evicts them
};

/// Most that an owner's operators in use may take with `wanted` more: what is pinned follows
/// access/share.hpp, so that a newcomer finds room. What is kept does not count as their own: it
/// would shut them out for ever. Without a name everything is one owner's.
struct PinnedShare {
  std::uint64_t own = 0;   ///< in use, an equal part of what is shared
  std::uint64_t used = 0;  ///< pinned, of all
  std::uint64_t most = 0;  ///< one owner may have now
  bool enough = false;
};
PinnedShare pinned_share(std::span<const Resident> residents, const std::string& owner,
                         std::uint64_t wanted, std::uint64_t limit);

/// The keys to evict so that the rest and `wanted` for `owner` fit in `limit`; none if that is
/// impossible or, as long as room comes otherwise, would be unfair. O(n log n + n owners).
///
/// Of what is not pinned, stale operators go first, the least recently used first. Then those of
/// who has most, `wanted` included, the least recently used first; nobody who has less than `owner`
/// would have gives anything, unless there is no room even when all that is in use by `owner` has
/// ended, or nothing is wanted and too much is held as it is. Operators of several owners count for
/// each with an equal part, and stay as long as they would for the one of them who has least. At
/// the end small ones are spared that the large ones make unnecessary.
std::optional<std::vector<std::string>> choose_victims(std::span<const Resident> residents,
                                                       const std::string& owner,
                                                       std::uint64_t wanted, std::uint64_t limit);

}  // namespace anticrack::operators
