// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/result_file.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <utility>

#include "store/digest.hpp"
#include "store/record_parts.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

static_assert(std::endian::native == std::endian::little, "lengths are little-endian");

constexpr std::array types{ArrayType::float64, ArrayType::int32, ArrayType::uint8};
constexpr std::string_view magic("ACRES\0\0\1", 8);  // the last: the version
constexpr std::size_t lengths = 2 * sizeof(std::uint32_t);
constexpr std::size_t max_header = std::size_t{16} << 20U;

/// Reads what is at an offset; throws where there is less.
using Read = std::function<void(std::uint64_t offset, std::span<std::byte> bytes)>;

class StoredBlock final : public BlockSource {
 public:
  StoredBlock(Read read, std::uint64_t begin, const disk::ResultHeader& header)
      : _read(std::move(read)), _begin(begin), _size(header.bytes()), _sha256(header.sha256()) {
    for (const disk::ArrayLayout& array : header.arrays()) {
      _arrays.push_back({array.name(),
                         disk::choice(types, array.type()),
                         {array.shape().begin(), array.shape().end()},
                         array.offset()});
    }
  }

  const std::vector<ArrayLayout>& arrays() const noexcept override { return _arrays; }
  std::uint64_t size() const noexcept override { return _size; }
  const std::string& sha256() const noexcept override { return _sha256; }
  void read(std::uint64_t offset, std::span<std::byte> bytes) const override {
    _read(_begin + offset, bytes);
  }

 private:
  Read _read;
  std::uint64_t _begin;
  std::uint64_t _size;
  std::string _sha256;
  std::vector<ArrayLayout> _arrays;
};

std::string number_bytes(std::uint32_t number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::uint32_t number_at(const std::byte* bytes) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

Error damaged(const std::string& place) {
  return {Reason::storage,
          "the result in " + place + " is damaged: delete its job and run it again"};
}

std::shared_ptr<const BlockSource> open_at(Read read, std::uint64_t size,
                                           const std::string& place) {
  std::array<std::byte, magic.size() + lengths> start{};
  read(0, start);
  const std::uint32_t length = number_at(start.data() + magic.size());
  if (std::memcmp(start.data(), magic.data(), magic.size()) != 0 || length > max_header) {
    throw damaged(place);
  }
  std::string bytes(length, '\0');
  read(start.size(), std::as_writable_bytes(std::span(bytes)));
  if (crc32c(std::as_bytes(std::span(bytes))) !=
      number_at(start.data() + magic.size() + sizeof length)) {
    throw damaged(place);
  }
  disk::ResultHeader header;
  disk::parse(bytes, header);
  const std::uint64_t begin = start.size() + length;
  if (size != begin + header.bytes()) {
    throw damaged(place);
  }
  return std::make_shared<StoredBlock>(std::move(read), begin, header);
}

}  // namespace

std::string result_header(const Block& block) {
  disk::ResultHeader header;
  for (const ArrayLayout& array : block.arrays) {
    disk::ArrayLayout& out = *header.add_arrays();
    out.set_name(array.name);
    out.set_type(disk::number(types, array.type));
    out.mutable_shape()->Assign(array.shape.begin(), array.shape.end());
    out.set_offset(array.offset);
  }
  header.set_bytes(block.bytes.size());
  header.set_sha256(block.sha256);
  const std::string bytes = disk::serialized(header);
  if (bytes.size() > max_header) {
    throw std::length_error("the layout of a result takes more than 16 MB");
  }
  return std::string(magic) + number_bytes(static_cast<std::uint32_t>(bytes.size())) +
         number_bytes(crc32c(std::as_bytes(std::span(bytes)))) + bytes;
}

std::shared_ptr<const BlockSource> open_result(Descriptor file, const std::string& path) {
  const std::uint64_t size = file_size(file, path);
  const auto shared = std::make_shared<const Descriptor>(std::move(file));
  return open_at(
      [shared, path](std::uint64_t offset, std::span<std::byte> bytes) {
        read_at(*shared, path, offset, bytes);
      },
      size, path);
}

std::shared_ptr<const BlockSource> open_result(std::string stored, const std::string& place) {
  const std::uint64_t size = stored.size();
  return open_at(
      [stored = std::move(stored), place](std::uint64_t offset, std::span<std::byte> bytes) {
        if (offset > stored.size() || bytes.size() > stored.size() - offset) {
          throw damaged(place);
        }
        std::memcpy(bytes.data(), stored.data() + offset, bytes.size());
      },
      size, place);
}

}  // namespace anticrack::store
