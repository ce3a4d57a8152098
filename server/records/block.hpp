// SPDX-License-Identifier: GPL-3.0-or-later
//
// Named arrays in one run of bytes, which ReadMesh and ReadResult stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "fields/fields.hpp"

namespace anticrack::records {

/// Its numbers are those of the API.
enum class ArrayType { float64 = 1, int32, uint8 };

/// The type of an array of these values: double, std::int32_t and enums of its size, std::uint8_t.
template <class Value>
inline constexpr ArrayType array_type = [] {
  static_assert(std::is_same_v<Value, double> || std::is_same_v<Value, std::int32_t> ||
                std::is_same_v<Value, std::uint8_t> ||
                (std::is_enum_v<Value> && sizeof(Value) == sizeof(std::int32_t)));
  return std::is_same_v<Value, double> ? ArrayType::float64
         : sizeof(Value) == 1          ? ArrayType::uint8
                                       : ArrayType::int32;
}();

/// One array: little-endian, row-major, at an offset that is a multiple of 8.
struct ArrayLayout {
  std::string name;
  ArrayType type = ArrayType::float64;
  std::vector<std::uint64_t> shape;
  std::uint64_t offset = 0;
};
ANTICRACK_FIELDS(ArrayLayout, name, type, shape, offset)

/// The offset of an array that follows `size` bytes.
constexpr std::uint64_t aligned(std::uint64_t size) {
  constexpr std::uint64_t alignment = 8;
  return (size + alignment - 1) / alignment * alignment;
}

/// The bytes of the array's entries, without those that align the next array.
std::uint64_t bytes_of(const ArrayLayout& array);

/// Immutable once built and shared.
struct Block {
  std::vector<ArrayLayout> arrays;
  std::vector<std::byte> bytes;
  std::string sha256;
};

/// A block that is read piece by piece, wherever it lies, so that a large result is never in memory
/// as a whole. Thread-safe. It stays readable while it is held, even if the store has erased it.
class BlockSource {
 public:
  virtual ~BlockSource() = default;
  /// The arrays in the order of their offsets.
  virtual const std::vector<ArrayLayout>& arrays() const noexcept = 0;
  virtual std::uint64_t size() const noexcept = 0;  ///< in bytes
  virtual const std::string& sha256() const noexcept = 0;
  /// Fills `bytes` from `offset` on; all must lie in the block. Throws errors::Error (storage).
  virtual void read(std::uint64_t offset, std::span<std::byte> bytes) const = 0;
};

/// A source that reads from a block in memory, which it shares.
std::shared_ptr<const BlockSource> in_memory(std::shared_ptr<const Block> block);

class BlockBuilder {
 public:
  /// Adds an array: a contiguous range of values that have an array_type. An empty `shape` means
  /// (values.size()). Throws std::invalid_argument if the shape does not fit.
  template <class Values>
  void add(std::string name, const Values& values, std::vector<std::uint64_t> shape = {}) {
    using Value = std::ranges::range_value_t<Values>;
    append(std::move(name), array_type<Value>, std::as_bytes(std::span(values)), values.size(),
           std::move(shape));
  }
  /// The block with its hash. The builder is empty afterwards.
  Block finish();
  /// The block without a hash, to be a part of another. The builder is empty afterwards.
  Block take() { return std::exchange(_block, {}); }

 private:
  void append(std::string name, ArrayType type, std::span<const std::byte> values,
              std::uint64_t count, std::vector<std::uint64_t> shape);

  Block _block;
};

}  // namespace anticrack::records
