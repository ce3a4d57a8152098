// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace anticrack::jobs {

/// How many of the ended jobs have to go, the oldest first, so that at most `max_count` with at
/// most `max_bytes` together are left. `bytes` is oldest first. The newest stays whatever its size,
/// or nobody could read its result. O(n).
std::size_t jobs_to_drop(const std::vector<std::uint64_t>& bytes, std::size_t max_count,
                         std::uint64_t max_bytes);

}  // namespace anticrack::jobs
