// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/freed_memory.hpp"

#include <malloc.h>

namespace anticrack::operators {

void map_large_blocks() noexcept {
  // Smaller blocks, a vector of the mesh among them, are many and short-lived: a system call and
  // page faults for each took a quarter of a load case with a million unknowns.
  constexpr int large = 4 << 20;
  static const int done = mallopt(M_MMAP_THRESHOLD, large);
  static_cast<void>(done);
}

void return_freed_memory() noexcept {
  malloc_trim(0);
}

}  // namespace anticrack::operators
