// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/block.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "client/error.hpp"
#include "digest/digest.hpp"

namespace anticrack::client {
namespace {

// Most memory to reserve for the announced size before its bytes arrive.
constexpr std::uint64_t largest_reservation = 64u << 20;

[[noreturn]] void damaged(const std::string& what) {
  throw Error(Code::data_loss, "the data arrived damaged: " + what);
}

}  // namespace

void BlockReceiver::accept(const v1::BlockLayout& layout) {
  const auto known = static_cast<std::uint32_t>(_block.layout.arrays_size());
  if (layout.first_array() > known) {
    damaged("arrays from " + std::to_string(layout.first_array()) + " on where " +
            std::to_string(known) + " was due");
  }
  if (!_started) {
    _block.layout = layout;
    _block.bytes.reserve(std::min<std::uint64_t>(layout.size(), largest_reservation));
    _started = true;
  } else if (layout.size() != _block.layout.size() || layout.sha256() != _block.layout.sha256()) {
    damaged("the block changed while it was read; fetch it again");
  } else if (layout.first_array() == known && known < _block.layout.array_count()) {
    _block.layout.mutable_arrays()->MergeFrom(layout.arrays());
  }
}

void BlockReceiver::accept(const v1::BlockChunk& chunk) {
  if (!_started) damaged("a chunk before the layout");
  if (chunk.offset() != offset()) {
    damaged("a chunk at " + std::to_string(chunk.offset()) + " where " + std::to_string(offset()) +
            " was due");
  }
  if (chunk.data().size() > _block.layout.size() - offset())
    damaged("more than the announced " + std::to_string(_block.layout.size()) + " bytes");
  const std::span<const std::byte> data = std::as_bytes(std::span(chunk.data()));
  if (digest::crc32c(data) != chunk.crc32c())
    damaged("the checksum of the chunk at " + std::to_string(chunk.offset()) + " is wrong");
  _block.bytes.insert(_block.bytes.end(), data.begin(), data.end());
}

Block BlockReceiver::finish() {
  if (!complete()) {
    damaged("it ended at " + std::to_string(offset()) + " of " +
            std::to_string(_block.layout.size()) + " bytes");
  }
  const std::string sha256 = digest::Sha256().add(_block.bytes).finish();
  if (sha256 != _block.layout.sha256())
    damaged("its sha256 is " + sha256 + " and not " + _block.layout.sha256());
  _started = false;
  return std::exchange(_block, {});
}

}  // namespace anticrack::client
