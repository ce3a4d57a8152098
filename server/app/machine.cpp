// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/machine.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <memory>
#include <thread>

#include "app/control_group.hpp"

namespace anticrack::app {
namespace {

struct FreeSet {
  void operator()(cpu_set_t* set) const noexcept { CPU_FREE(set); }
};

/// The number of processors on which this process may run.
int own_processors() {
  constexpr int most = 1 << 16;
  for (int room = 1024; room <= most; room *= 2) {
    const std::unique_ptr<cpu_set_t, FreeSet> set(CPU_ALLOC(static_cast<std::size_t>(room)));
    const std::size_t bytes = CPU_ALLOC_SIZE(static_cast<std::size_t>(room));
    if (set && ::sched_getaffinity(0, bytes, set.get()) == 0)
      return std::max(1, CPU_COUNT_S(bytes, set.get()));
    if (errno != EINVAL) break;  // EINVAL: the machine has more than `room`
  }
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::uint64_t physical_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long page = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return 2ULL << 30;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
}

}  // namespace

Machine this_machine(const std::string& root) {
  Machine machine{physical_memory(), "the memory of the machine", own_processors()};
  const GroupLimits group = group_limits(root);
  if (group.memory_bytes && *group.memory_bytes < machine.memory_bytes) {
    machine.memory_bytes = *group.memory_bytes;
    machine.memory_limit = group.memory_file;
  }
  if (group.processors) {
    const double quota = std::clamp(std::ceil(*group.processors), 1.0, 1e6);
    machine.processors = std::min(machine.processors, static_cast<int>(quota));
  }
  return machine;
}

}  // namespace anticrack::app
