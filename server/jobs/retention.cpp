// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/retention.hpp"

#include <numeric>

namespace anticrack::jobs {

std::size_t jobs_to_drop(const std::vector<std::uint64_t>& bytes, std::size_t max_count,
                         std::uint64_t max_bytes) {
  std::uint64_t held = std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
  std::size_t dropped = 0;
  while (dropped + 1 < bytes.size() && (bytes.size() - dropped > max_count || held > max_bytes)) {
    held -= bytes[dropped++];
  }
  return dropped;
}

}  // namespace anticrack::jobs
