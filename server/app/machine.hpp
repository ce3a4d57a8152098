// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of the machine that this process may use, from which defaults are made.
#pragma once

#include <cstdint>
#include <string>

namespace anticrack::app {

struct Machine {
  std::uint64_t memory_bytes = 0;
  std::string memory_limit;  ///< the source of the limit: "the memory of the machine", or a file
  int processors = 1;
};

/// Memory: the least of what the machine has and its control groups allow (control_group.hpp);
/// ulimit -v is about address space (address_space.hpp). Processors: those on which the process may
/// run (taskset, cpusets), at most the quota of its control groups, rounded up. `root`: as for
/// group_limits().
Machine this_machine(const std::string& root = "");

}  // namespace anticrack::app
