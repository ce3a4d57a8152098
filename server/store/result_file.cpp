// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/result_file.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <functional>
#include <utility>

#include "api/translations.hpp"
#include "digest/digest.hpp"

namespace anticrack::store {

namespace {

using errors::Error;
using errors::Reason;

static_assert(std::endian::native == std::endian::little, "lengths are little-endian");

constexpr std::string_view magic("ACRES\0\0\2", 8);  // the last byte is the version
constexpr std::size_t lengths = 2 * sizeof(std::uint32_t);
constexpr std::size_t max_header = std::size_t{64} << 20U;

/// Reads bytes at an offset; throws if there are fewer.
using Read = std::function<void(std::uint64_t offset, std::span<std::byte> bytes)>;

class StoredBlock final : public records::BlockSource {
 public:
  /// Throws errors::Error (invalid_argument).
  StoredBlock(Read read, std::uint64_t begin, const v1::BlockLayout& layout)
      : _read(std::move(read)), _begin(begin), _size(layout.size()), _sha256(layout.sha256()) {
    api::read_field(layout, "arrays", _arrays);
  }

  const std::vector<records::ArrayLayout>& arrays() const noexcept override { return _arrays; }
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
  std::vector<records::ArrayLayout> _arrays;
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

/// Opens a result. `name`: the hash of all that comes before the bytes; empty: not known.
std::shared_ptr<const records::BlockSource> open_at(Read read, std::uint64_t size,
                                                    const std::string& place,
                                                    const std::string& name) {
  std::array<std::byte, magic.size() + lengths> start{};
  read(0, start);
  const std::uint32_t length = number_at(start.data() + magic.size());
  if (std::memcmp(start.data(), magic.data(), magic.size()) != 0 || length > max_header)
    throw damaged(place);
  std::string bytes(length, '\0');
  read(start.size(), std::as_writable_bytes(std::span(bytes)));
  if (digest::crc32c(std::as_bytes(std::span(bytes))) !=
      number_at(start.data() + magic.size() + sizeof length))
    throw damaged(place);
  if (!name.empty() && digest::Sha256().add(start).add(bytes).finish() != name)
    throw damaged(place);
  v1::BlockLayout layout;
  const std::uint64_t begin = start.size() + length;
  if (!layout.ParseFromString(bytes) || size != begin + layout.size()) throw damaged(place);
  try {
    return std::make_shared<StoredBlock>(std::move(read), begin, layout);
  } catch (const Error&) {
    throw damaged(place);
  }
}

}  // namespace

std::string result_header(const records::BlockSource& block) {
  const std::string bytes =
      api::serialized(api::layout_of(block.arrays(), block.size(), block.sha256()));
  if (bytes.size() > max_header) {
    throw Error(Reason::limit_exceeded, "{} arrays are too many for one result: split the job",
                block.arrays().size());
  }
  return std::string(magic) + number_bytes(static_cast<std::uint32_t>(bytes.size())) +
         number_bytes(digest::crc32c(std::as_bytes(std::span(bytes)))) + bytes;
}

std::string name_of_result(const std::string& header) {
  return digest::Sha256().add(header).finish();
}

std::shared_ptr<const records::BlockSource> open_result(base::Descriptor file,
                                                        const std::string& path,
                                                        const std::string& name) {
  const std::uint64_t size = file_size(file, path);
  const auto shared = std::make_shared<const base::Descriptor>(std::move(file));
  return open_at(
      [shared, path](std::uint64_t offset, std::span<std::byte> bytes) {
        read_at(*shared, path, offset, bytes);
      },
      size, path, name);
}

std::shared_ptr<const records::BlockSource> open_result(std::string stored,
                                                        const std::string& place) {
  const std::uint64_t size = stored.size();
  auto block = open_at(
      [stored = std::move(stored), place](std::uint64_t offset, std::span<std::byte> bytes) {
        if (offset > stored.size() || bytes.size() > stored.size() - offset) throw damaged(place);
        std::memcpy(bytes.data(), stored.data() + offset, bytes.size());
      },
      size, place, {});
  require_whole(*block, place);
  return block;
}

std::shared_ptr<const records::BlockSource> open_result(Read read, std::uint64_t size,
                                                        const std::string& place) {
  return open_at(std::move(read), size, place, {});
}

void require_whole(const records::BlockSource& block, const std::string& place) {
  const auto read = [&](std::uint64_t offset, std::span<std::byte> bytes) {
    block.read(offset, bytes);
  };
  if (digest::sha256_of(block.size(), read) != block.sha256()) throw damaged(place);
}

}  // namespace anticrack::store
