// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which operators to evict for another one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace anticrack::operators {

struct Candidate {
  std::uint64_t bytes = 0;
  std::uint64_t last_use = 0;  ///< larger is more recent
  bool pinned = false;
};

/// Indices of the candidates to evict, least recently used first, so that the rest and `wanted`
/// more bytes fit in `budget`; none if evicting all unpinned ones would not suffice. O(n log n).
std::optional<std::vector<std::size_t>> evictions(const std::vector<Candidate>& candidates,
                                                  std::uint64_t wanted, std::uint64_t budget);

}  // namespace anticrack::operators
