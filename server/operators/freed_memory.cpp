// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/freed_memory.hpp"

#include <malloc.h>

namespace anticrack::operators {

void map_large_blocks() noexcept {
  // Smaller blocks, a vector of the mesh among them, are many and short-lived: page faults for each
  // took a quarter of a load case with a million unknowns. So what is freed of the heap stays, up
  // to some tens of megabytes; return_freed_memory() takes these back as well.
  constexpr int mebibyte = 1 << 20;
  static const bool done =
      mallopt(M_MMAP_THRESHOLD, 4 * mebibyte) == 1 && mallopt(M_TRIM_THRESHOLD, 64 * mebibyte) == 1;
  static_cast<void>(done);
}

void return_freed_memory() noexcept {
  malloc_trim(0);
}

}  // namespace anticrack::operators
