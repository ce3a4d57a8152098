// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/freed_memory.hpp"

#include <malloc.h>

#include "base/large.hpp"

namespace anticrack::operators {

void set_up_heaps() noexcept {
  static const bool done = [] {
    // Smaller blocks are many and short-lived: a system call and page faults for each took a
    // quarter of a load case with a million unknowns. 32 MB is the most that malloc allows. What
    // is freed stays for the next load, until return_freed_memory().
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
    // Threads that factorise grew and shrank their heaps by a few hundred pages and waited for each
    // other in the kernel: 7 ms instead of 5 for 11,000 triangles.
    mallopt(M_TOP_PAD, 4 << 20);
    return true;
  }();
  static_cast<void>(done);
}

void return_freed_memory() noexcept {
  base::return_kept_blocks();
  malloc_trim(0);
}

}  // namespace anticrack::operators
