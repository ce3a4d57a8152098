// SPDX-License-Identifier: GPL-3.0-or-later
//
// Arrays of the size of a mesh that are filled at once.
#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace anticrack::base {

/// Memory for `bytes`; null if there is none. Blocks of 4 MB and more have huge pages, and when
/// they are given back they are kept for the next of the same size, the last 256 MB of them:
/// clearing pages that the system hands out anew took a tenth of the bounds of a million triangles.
void* take_block(std::size_t bytes) noexcept;
void give_block(void* block, std::size_t bytes) noexcept;
/// Returns the blocks that are kept to the system.
void return_kept_blocks() noexcept;

/// Leaves numbers uninitialised, and takes huge pages for large arrays: setting memory to zero and
/// faults of small pages took a quarter of the bounds of a million triangles.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class Other>
  explicit LargeAllocator(const LargeAllocator<Other>&) noexcept {}

  T* allocate(std::size_t count) {
    void* const memory = take_block(count * sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept { give_block(memory, count * sizeof(T)); }

  template <class Made>
  void construct(Made* at) noexcept {
    ::new (static_cast<void*>(at)) Made;
  }
  template <class Made, class... From>
  void construct(Made* at, From&&... from) {
    ::new (static_cast<void*>(at)) Made(std::forward<From>(from)...);
  }
  bool operator==(const LargeAllocator&) const = default;
};

/// Large<T>(n) has n values that are not set.
template <class T>
using Large = std::vector<T, LargeAllocator<T>>;

}  // namespace anticrack::base
