// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/block_feed.hpp"

#include <span>
#include <string>

#include "digest/digest.hpp"
#include "errors/errors.hpp"

namespace anticrack::rpc {

void require_offset(const records::BlockSource& block, std::uint64_t offset) {
  if (offset <= block.size()) return;
  throw errors::Error(errors::Reason::offset_out_of_range, "offset {} is past the end of {} bytes",
                      offset, block.size())
      .at("offset")
      .with("size", std::to_string(block.size()));
}

v1::BlockChunk chunk_of(const records::BlockSource& block, std::uint64_t offset) {
  v1::BlockChunk chunk;
  chunk.set_offset(offset);
  std::string& data = *chunk.mutable_data();
  data.resize(std::min<std::uint64_t>(block.size() - offset, max_chunk_bytes));
  const auto bytes = std::as_writable_bytes(std::span(data));
  block.read(offset, bytes);
  chunk.set_crc32c(digest::crc32c(bytes));
  return chunk;
}

}  // namespace anticrack::rpc
