// SPDX-License-Identifier: GPL-3.0-or-later
//
// Named arrays in one run of bytes: what ReadMesh and ReadResult stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace anticrack::store {

enum class ArrayType { float64, int32 };

/// One array: little-endian, row-major, at an offset that is a multiple of 8.
struct ArrayLayout {
  std::string name;
  ArrayType type = ArrayType::float64;
  std::vector<std::uint64_t> shape;
  std::uint64_t offset = 0;
};

/// Immutable once built and shared; chunks are cut out of `bytes` without a copy.
struct Block {
  std::vector<ArrayLayout> arrays;
  std::vector<std::byte> bytes;
  std::string sha256;
};

class BlockBuilder {
 public:
  /// `shape` empty: (values.size()). Throws std::invalid_argument where the shape does not fit.
  void add(std::string name, std::span<const double> values, std::vector<std::uint64_t> shape = {});
  void add(std::string name, std::span<const std::int32_t> values,
           std::vector<std::uint64_t> shape = {});
  /// Computes the hash. The builder is empty after.
  Block finish();

 private:
  Block _block;
};

}  // namespace anticrack::store
