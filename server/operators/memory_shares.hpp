// SPDX-License-Identifier: GPL-3.0-or-later
//
// The policy of whose operators are evicted when memory is needed, without threads or locks.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace anticrack::operators {

/// Operators of a mesh that are in memory or being made.
struct Resident {
  const std::string* key = nullptr;
  const std::set<std::string>* owners = nullptr;  ///< all who asked for them; at least one
  std::uint64_t bytes = 0;
  std::uint64_t last_use = 0;  ///< larger: later
  bool stale = false;          ///< not used for long
  bool in_use = false;         ///< by a job or a factorisation; cannot be evicted until it ends
  bool kept = false;           ///< pinned until somebody evicts them
};

/// The most memory that operators in use by an owner may take, and whether `wanted` more is within
/// it. Pinned memory follows access/share.hpp, so that a newcomer finds room. Kept operators do not
/// count as the owner's own, as they would shut the owner out for ever. An empty owner means that
/// everything belongs to one owner.
struct PinnedShare {
  std::uint64_t own = 0;   ///< in use by the owner; shared operators count with an equal part
  std::uint64_t used = 0;  ///< pinned by all owners
  std::uint64_t most = 0;  ///< that one owner may have now
  bool enough = false;
};
PinnedShare pinned_share(std::span<const Resident> residents, const std::string& owner,
                         std::uint64_t wanted, std::uint64_t limit);

/// The keys to evict so that the rest and `wanted` for `owner` fit in `limit`; none if that is
/// impossible, or if it would be unfair and room will come without it. O(n log n + n owners).
///
/// Only operators that are not pinned are evicted. First go the stale ones, the least recently used
/// first. Then the owner who has most, `wanted` included, gives the least recently used one, again
/// and again. Owners who have less than `owner` would have give nothing, unless there would be no
/// room even after all uses by `owner` have ended, or nothing is wanted and too much is held
/// already. Operators of several owners count for each with an equal part, and are treated as those
/// of the owner who has least. At the end, evictions that turn out to be unnecessary are taken
/// back.
std::optional<std::vector<std::string>> choose_victims(std::span<const Resident> residents,
                                                       const std::string& owner,
                                                       std::uint64_t wanted, std::uint64_t limit);

}  // namespace anticrack::operators
