// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/block_feed.hpp"

#include <span>
#include <string>

#include "errors/errors.hpp"
#include "store/digest.hpp"

namespace anticrack::rpc {

void require_offset(const store::Block& block, std::uint64_t offset) {
  if (offset <= block.bytes.size()) return;
  throw errors::Error(errors::Reason::offset_out_of_range,
                      "offset " + std::to_string(offset) + " is past the end of " +
                          std::to_string(block.bytes.size()) + " bytes")
      .at("offset")
      .with("size", std::to_string(block.bytes.size()));
}

v1::BlockChunk chunk_of(const store::Block& block, std::uint64_t offset) {
  const std::span<const std::byte> bytes = std::span(block.bytes).subspan(offset);
  const auto piece = bytes.first(std::min(bytes.size(), max_chunk_bytes));
  v1::BlockChunk chunk;
  chunk.set_offset(offset);
  chunk.set_data(piece.data(), piece.size());
  chunk.set_crc32c(store::crc32c(piece));
  return chunk;
}

}  // namespace anticrack::rpc
