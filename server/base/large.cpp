// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/large.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <utility>

namespace anticrack::base {
namespace {

constexpr std::size_t line = 64, huge = std::size_t{2} << 20, kept_from = std::size_t{16} << 20,
                      kept_at_most = std::size_t{256} << 20;

constexpr std::size_t alignment_of(std::size_t bytes) { return bytes < 2 * huge ? line : huge; }
constexpr std::size_t rounded(std::size_t bytes) {
  const std::size_t to = alignment_of(bytes);
  return (bytes + to - 1) / to * to;
}

/// Blocks that are kept, by their size; none is null. It lives as long as the process.
class Kept {
 public:
  void* take(std::size_t size) noexcept {
    const std::lock_guard lock(_mutex);
    const auto found = std::ranges::find(_blocks, size, &Block::size);
    if (found == _blocks.end()) return nullptr;
    return std::exchange(*found, {}).at;
  }
  /// False: there is no room for it.
  bool keep(void* block, std::size_t size) noexcept {
    const std::lock_guard lock(_mutex);
    std::size_t all = size;
    for (const Block& one : _blocks) all += one.size;
    const auto free = std::ranges::find(_blocks, nullptr, &Block::at);
    if (all > kept_at_most || free == _blocks.end()) return false;
    *free = {block, size};
    return true;
  }
  void return_all() noexcept {
    const std::lock_guard lock(_mutex);
    for (Block& one : _blocks) std::free(std::exchange(one, {}).at);
  }

 private:
  struct Block {
    void* at = nullptr;
    std::size_t size = 0;
  };
  std::mutex _mutex;
  std::array<Block, kept_at_most / kept_from> _blocks;
};

Kept& kept() {
  static Kept blocks;
  return blocks;
}

}  // namespace

void* take_block(std::size_t bytes) noexcept {
  const std::size_t size = rounded(bytes), alignment = alignment_of(bytes);
  if (size >= kept_from)
    if (void* const block = kept().take(size)) return block;
  void* const block = std::aligned_alloc(alignment, size);
  if (block != nullptr && alignment == huge)
    static_cast<void>(madvise(block, size, MADV_HUGEPAGE));  // a hint
  return block;
}

void give_block(void* block, std::size_t bytes) noexcept {
  const std::size_t size = rounded(bytes);
  if (size < kept_from || !kept().keep(block, size)) std::free(block);
}

void return_kept_blocks() noexcept { kept().return_all(); }

}  // namespace anticrack::base
