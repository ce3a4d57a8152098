// SPDX-License-Identifier: GPL-3.0-or-later
//
// Named arrays in one run of bytes, as ReadMesh and ReadResult stream them, and how they are put
// together again from checked pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "anticrack/v1/mesh.pb.h"

namespace anticrack::client {

/// Received whole and checked against its hash.
struct Block {
  v1::BlockLayout layout;
  std::vector<std::byte> bytes;
};

/// Takes layouts and chunks as they come, over as many streams as it needs.
/// Throws Error (data_loss) for what does not fit: a chunk whose crc32c or offset is wrong, more
/// bytes than announced, a layout other than the first one's, a wrong hash in the end.
class BlockReceiver {
 public:
  /// First messages of every stream.
  void accept(const v1::BlockLayout& layout);
  void accept(const v1::BlockChunk& chunk);

  /// Where the next stream has to begin.
  std::uint64_t offset() const noexcept { return _block.bytes.size(); }
  bool complete() const noexcept {
    return _started && offset() == _block.layout.size() &&
           _block.layout.array_count() <= static_cast<std::uint32_t>(_block.layout.arrays_size());
  }
  /// Checks the hash. The receiver is empty after.
  Block finish();

 private:
  bool _started = false;
  Block _block;
};

}  // namespace anticrack::client
