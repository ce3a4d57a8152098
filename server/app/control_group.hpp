// SPDX-License-Identifier: GPL-3.0-or-later
//
// Limits that the kernel's control groups set to this process.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace anticrack::app {

struct GroupLimits {
  std::optional<std::uint64_t> memory_bytes;
  std::string memory_file;           ///< the file with this limit
  std::optional<double> processors;  ///< quota over period
};

/// The tightest limits of the process's groups and of all groups around them that can be seen, of
/// versions 1 and 2, also where both are mounted: memory.max, memory.high (above it a process is
/// slowed down), memory.limit_in_bytes and what memory.stat says of the groups above; cpu.max,
/// cpu.cfs_quota_us. Files that are missing, damaged or "max" limit nothing. `root`: the folder of
/// /proc and /sys; empty for those of this machine.
GroupLimits group_limits(const std::string& root = "");

}  // namespace anticrack::app
