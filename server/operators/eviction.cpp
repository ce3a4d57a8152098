// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/eviction.hpp"

#include <algorithm>

namespace anticrack::operators {

std::optional<std::vector<std::size_t>> evictions(const std::vector<Candidate>& candidates,
                                                  std::uint64_t wanted, std::uint64_t budget) {
  if (wanted > budget) return std::nullopt;
  const std::uint64_t room = budget - wanted;
  std::uint64_t held = 0;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    held += candidates[i].bytes;
    if (!candidates[i].pinned) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return candidates[a].last_use < candidates[b].last_use;
  });
  std::size_t count = 0;
  for (; held > room && count < order.size(); ++count) held -= candidates[order[count]].bytes;
  if (held > room) return std::nullopt;
  order.resize(count);
  return order;
}

}  // namespace anticrack::operators
