// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/block.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "store/digest.hpp"

namespace anticrack::store {

static_assert(std::endian::native == std::endian::little, "arrays go into a block as they are");

namespace {

constexpr std::size_t alignment = 8;

/// True when the shape holds exactly `count` values.
bool fits(const std::vector<std::uint64_t>& shape, std::uint64_t count) {
  std::uint64_t product = 1;
  for (const std::uint64_t extent : shape) {
    if (extent != 0 && product > count / extent) {
      return false;
    }
    product *= extent;
  }
  return product == count;
}

template <class T>
void append(Block& block, std::string name, ArrayType type, std::span<const T> values,
            std::vector<std::uint64_t> shape) {
  if (shape.empty()) {
    shape = {values.size()};
  }
  if (!fits(shape, values.size())) {
    throw std::invalid_argument("array " + name + ": its shape does not hold " +
                                std::to_string(values.size()) + " values");
  }
  const std::size_t offset = (block.bytes.size() + alignment - 1) / alignment * alignment;
  block.bytes.resize(offset);
  const std::span<const std::byte> bytes = std::as_bytes(values);
  block.bytes.insert(block.bytes.end(), bytes.begin(), bytes.end());
  block.arrays.push_back({std::move(name), type, std::move(shape), offset});
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

std::shared_ptr<const BlockSource> in_memory(std::shared_ptr<const Block> block) {
  return std::make_shared<MemoryBlock>(std::move(block));
}

void BlockBuilder::add(std::string name, std::span<const double> values,
                       std::vector<std::uint64_t> shape) {
  append(_block, std::move(name), ArrayType::float64, values, std::move(shape));
}

void BlockBuilder::add(std::string name, std::span<const std::int32_t> values,
                       std::vector<std::uint64_t> shape) {
  append(_block, std::move(name), ArrayType::int32, values, std::move(shape));
}

Block BlockBuilder::finish() {
  _block.sha256 = Sha256().add(_block.bytes).finish();
  return std::exchange(_block, {});
}

}  // namespace anticrack::store
