// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/large.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>

namespace anticrack::base {
namespace {

constexpr std::size_t line = 64, huge = std::size_t{2} << 20, kept_from = 2 * huge,
                      kept_at_most = std::size_t{256} << 20;

constexpr std::size_t rounded(std::size_t bytes) {
  const std::size_t to = bytes < kept_from ? line : huge;
  return (bytes + to - 1) / to * to;
}

/// Blocks that are kept, the oldest first. It lives as long as the process.
class Kept {
 public:
  /// The youngest block of a size; null if there is none.
  void* take(std::size_t size) noexcept {
    const std::lock_guard lock(_mutex);
    for (std::size_t i = _count; i-- > 0;)
      if (_blocks[i].size == size) return remove(i);
    return nullptr;
  }
  /// Frees the oldest ones if there is no room.
  void keep(void* block, std::size_t size) noexcept {
    const std::lock_guard lock(_mutex);
    while (_count > 0 && _bytes + size > kept_at_most) std::free(remove(0));
    if (size > kept_at_most) return std::free(block);
    _blocks[_count++] = {block, size};
    _bytes += size;
  }
  void free_all() noexcept {
    const std::lock_guard lock(_mutex);
    while (_count > 0) std::free(remove(0));
  }

 private:
  struct Block {
    void* at;
    std::size_t size;
  };

  void* remove(std::size_t i) noexcept {
    void* const block = _blocks[i].at;
    _bytes -= _blocks[i].size;
    std::copy(_blocks.begin() + i + 1, _blocks.begin() + _count, _blocks.begin() + i);
    --_count;
    return block;
  }

  std::mutex _mutex;
  std::array<Block, kept_at_most / kept_from> _blocks;
  std::size_t _count = 0, _bytes = 0;
};

Kept& kept() {
  static Kept blocks;
  return blocks;
}

}  // namespace

void* take_block(std::size_t bytes) noexcept {
  const std::size_t size = rounded(bytes);
  if (size < kept_from) return std::aligned_alloc(line, size);
  if (void* const block = kept().take(size)) return block;
  void* const block = std::aligned_alloc(huge, size);
  if (block != nullptr) static_cast<void>(madvise(block, size, MADV_HUGEPAGE));  // a hint
  return block;
}

void give_block(void* block, std::size_t bytes) noexcept {
  const std::size_t size = rounded(bytes);
  if (size < kept_from) return std::free(block);
  kept().keep(block, size);
}

void return_kept_blocks() noexcept { kept().free_all(); }

}  // namespace anticrack::base
