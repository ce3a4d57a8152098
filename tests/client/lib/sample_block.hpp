// SPDX-License-Identifier: GPL-3.0-or-later
//
// A block as the server sends it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include "anticrack/v1/mesh.pb.h"
#include "digest/digest.hpp"

namespace anticrack::client {

/// `size` bytes that differ from place to place.
inline std::string sample_bytes(std::size_t size) {
  std::string bytes(size, '\0');
  for (std::size_t i = 0; i < size; ++i) {
    bytes[i] = static_cast<char>(i * 31 + i / 251);
  }
  return bytes;
}

inline v1::BlockLayout sample_layout(const std::string& bytes) {
  v1::BlockLayout layout;
  layout.set_size(bytes.size());
  layout.set_sha256(digest::Sha256().add(bytes).finish());
  auto& array = *layout.add_arrays();
  array.set_name("nodes");
  array.set_type(v1::ArrayLayout::TYPE_FLOAT64);
  array.add_shape(bytes.size() / 8);
  return layout;
}

inline v1::BlockChunk sample_chunk(const std::string& bytes, std::size_t offset, std::size_t size) {
  v1::BlockChunk chunk;
  chunk.set_offset(offset);
  chunk.set_data(bytes.substr(offset, size));
  chunk.set_crc32c(digest::crc32c(std::as_bytes(std::span(chunk.data()))));
  return chunk;
}

}  // namespace anticrack::client
