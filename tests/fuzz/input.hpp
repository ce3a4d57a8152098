// SPDX-License-Identifier: GPL-3.0-or-later
//
// What fuzz targets share: how bytes are cut into what a target takes, and how it says that
// something is broken.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace anticrack::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// An oracle's complaint: libFuzzer keeps the input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", what);
  std::abort();
}

/// Walks over an input that is a sequence: a selector, and pieces with their length (2 bytes,
/// little-endian) before them. Cut off, it gives what there is.
class Pieces {
 public:
  explicit Pieces(std::string_view bytes) : _left(bytes) {}

  bool empty() const { return _left.empty(); }
  /// 0 at the end.
  std::uint8_t selector() {
    const std::string_view byte = take(1);
    return byte.empty() ? 0 : static_cast<std::uint8_t>(byte.front());
  }
  std::string piece() {
    const std::size_t low = selector();
    const std::size_t high = selector();
    return std::string(take(low + 256 * high));
  }
  std::string rest() { return std::string(take(_left.size())); }

 private:
  std::string_view take(std::size_t count) {
    const std::string_view taken = _left.substr(0, count);
    _left.remove_prefix(taken.size());
    return taken;
  }

  std::string_view _left;
};

/// A piece as `Pieces` reads it, for seeds; at most 65535 bytes.
inline std::string as_piece(const std::string& bytes) {
  const std::size_t size = std::min<std::size_t>(bytes.size(), 65535);
  std::string piece{static_cast<char>(size & 255U), static_cast<char>(size >> 8U)};
  return piece.append(bytes, 0, size);
}

}  // namespace anticrack::fuzz
