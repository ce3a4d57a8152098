// SPDX-License-Identifier: GPL-3.0-or-later
#include "records/block.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "digest/digest.hpp"

namespace anticrack::records {

static_assert(std::endian::native == std::endian::little, "arrays go into a block as they are");

namespace {

/// Whether the shape has exactly `count` values.
bool fits(const std::vector<std::uint64_t>& shape, std::uint64_t count) {
  if (std::ranges::count(shape, 0U) > 0) return count == 0;
  std::uint64_t product = 1;
  for (const std::uint64_t extent : shape) {
    if (product > count / extent) return false;
    product *= extent;
  }
  return product == count;
}

std::size_t bytes_of(ArrayType type) {
  switch (type) {
    case ArrayType::float64:
      return sizeof(double);
    case ArrayType::int32:
      return sizeof(std::int32_t);
    case ArrayType::uint8:
      break;
  }
  return sizeof(std::uint8_t);
}

class MemoryBlock final : public BlockSource {
 public:
  explicit MemoryBlock(std::shared_ptr<const Block> block) : _block(std::move(block)) {}
  const std::vector<ArrayLayout>& arrays() const noexcept override { return _block->arrays; }
  std::uint64_t size() const noexcept override { return _block->bytes.size(); }
  const std::string& sha256() const noexcept override { return _block->sha256; }
  void read(std::uint64_t offset, std::span<std::byte> bytes) const override {
    const std::span<const std::byte> all(_block->bytes);
    std::ranges::copy(all.subspan(offset, bytes.size()), bytes.begin());
  }

 private:
  std::shared_ptr<const Block> _block;
};

}  // namespace

std::uint64_t bytes_of(const ArrayLayout& array) {
  std::uint64_t bytes = bytes_of(array.type);
  for (const std::uint64_t extent : array.shape) bytes *= extent;
  return bytes;
}

std::shared_ptr<const BlockSource> in_memory(std::shared_ptr<const Block> block) {
  return std::make_shared<MemoryBlock>(std::move(block));
}

void BlockBuilder::append(std::string name, ArrayType type, std::span<const std::byte> values,
                          std::uint64_t count, std::vector<std::uint64_t> shape) {
  if (shape.empty()) shape = {count};
  if (!fits(shape, count)) {
    throw std::invalid_argument(
        fmt::format("array {}: its shape does not hold {} values", name, count));
  }
  const std::size_t offset = aligned(_block.bytes.size());
  _block.bytes.resize(offset);
  _block.bytes.insert(_block.bytes.end(), values.begin(), values.end());
  _block.arrays.push_back({std::move(name), type, std::move(shape), offset});
}

Block BlockBuilder::finish() {
  _block.sha256 = digest::Sha256().add(_block.bytes).finish();
  return take();
}

}  // namespace anticrack::records
