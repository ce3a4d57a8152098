// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sends a block, first its layout and then its bytes in chunks, for ReadMesh and ReadResult.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "anticrack/v1/mesh.pb.h"
#include "api/translations.hpp"
#include "records/block.hpp"
#include "rpc/feed.hpp"

namespace anticrack::rpc {

constexpr std::size_t max_chunk_bytes = 1u << 20;

/// Throws errors::Error (offset_out_of_range) if `offset` is beyond the end.
void require_offset(const records::BlockSource& block, std::uint64_t offset);

/// The bytes from `offset` on, at most max_chunk_bytes, with their checksum. Throws errors::Error
/// (storage).
v1::BlockChunk chunk_of(const records::BlockSource& block, std::uint64_t offset);

/// Reads each chunk only when it is to be sent, so a large block is never in memory as a whole.
/// `next` waits for the disk. `Response` has `layout` and `chunk`.
template <class Response>
class BlockFeed final : public Feed<Response> {
 public:
  using Next = typename Feed<Response>::Next;

  /// Throws errors::Error (offset_out_of_range).
  BlockFeed(std::shared_ptr<const records::BlockSource> block, std::uint64_t offset)
      : _block(std::move(block)), _offset(offset) {
    require_offset(*_block, offset);
  }

  Next next(Response& response) override {
    if (!_layout_sent) {
      *response.mutable_layout() = api::layout_of(*_block, _arrays_sent);
      _arrays_sent += api::max_layout_arrays;
      _layout_sent = _arrays_sent >= _block->arrays().size();
      return Next::message;
    }
    if (_offset >= _block->size()) return Next::end;
    *response.mutable_chunk() = chunk_of(*_block, _offset);
    _offset += response.chunk().data().size();
    return Next::message;
  }

 private:
  const std::shared_ptr<const records::BlockSource> _block;
  std::uint64_t _offset;
  std::size_t _arrays_sent = 0;
  bool _layout_sent = false;
};

}  // namespace anticrack::rpc
