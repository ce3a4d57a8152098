// SPDX-License-Identifier: GPL-3.0-or-later
//
// Arrays of the size of a mesh that are filled at once.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace anticrack::base {

/// Leaves numbers uninitialised, and takes huge pages for large arrays: setting memory to zero and
/// faults of small pages took a quarter of the bounds of a million triangles.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class Other>
  explicit LargeAllocator(const LargeAllocator<Other>&) noexcept {}

  T* allocate(std::size_t count) {
    constexpr std::size_t line = 64, huge = std::size_t{2} << 20;
    const std::size_t bytes = count * sizeof(T), alignment = bytes < 2 * huge ? line : huge;
    const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
    void* const memory = std::aligned_alloc(alignment, rounded);
    if (memory == nullptr) throw std::bad_alloc();
    if (alignment == huge) static_cast<void>(madvise(memory, rounded, MADV_HUGEPAGE));  // a hint
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) noexcept { std::free(memory); }

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
