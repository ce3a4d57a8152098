// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reassembles and checks named arrays in one byte string, as ReadMesh and ReadResult stream them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "anticrack/v1/mesh.pb.h"

namespace anticrack::client {

/// A block that was received completely and checked against its hash.
struct Block {
  v1::BlockLayout layout;
  std::vector<std::byte> bytes;
};

/// Takes layouts and chunks as they come, from as many streams as it needs. Throws Error
/// (data_loss) for parts that do not fit: a chunk with a wrong crc32c or offset, more bytes than
/// announced, a layout that differs from the first one, a wrong hash at the end.
class BlockReceiver {
 public:
  /// Takes a layout, from the first messages of a stream.
  void accept(const v1::BlockLayout& layout);
  void accept(const v1::BlockChunk& chunk);

  /// The offset at which the next stream has to begin.
  std::uint64_t offset() const noexcept { return _block.bytes.size(); }
  bool complete() const noexcept {
    return _started && offset() == _block.layout.size() &&
           _block.layout.array_count() <= static_cast<std::uint32_t>(_block.layout.arrays_size());
  }
  /// Checks the hash and returns the block. The receiver is empty afterwards.
  Block finish();

 private:
  bool _started = false;
  Block _block;
};

}  // namespace anticrack::client
