// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/block.hpp"

namespace anticrack::results {
namespace {

constexpr const char* compare_versions =
    "the server and this client do not understand each other: compare their versions with "
    "`anticrack server`";

}  // namespace

std::string text_of(const std::vector<std::uint64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i == 0 ? "" : ",") + std::to_string(shape[i]);
  return text + ")";
}

std::uint64_t byte_count(const std::string& subject, const ArrayView& array) {
  std::uint64_t bytes = bytes_of(array.type);
  for (const std::uint64_t extent : array.shape) {
    if (__builtin_mul_overflow(bytes, extent, &bytes)) {
      throw Error(subject,
                  "array " + array.name + " has the impossible shape " + text_of(array.shape),
                  compare_versions);
    }
  }
  return bytes;
}

void Block::fail(const std::string& cause) const { throw Error(_subject, cause, compare_versions); }

ArrayView view(std::string name, ArrayView::Type type, std::vector<std::uint64_t> shape,
               std::uint64_t offset, std::span<const std::byte> block) {
  const std::string subject = "a block of the server";
  ArrayView array{std::move(name), type, std::move(shape), {}};
  const std::uint64_t bytes = byte_count(subject, array);
  if (offset > block.size() || bytes > block.size() - offset) {
    throw Error(subject,
                "array " + array.name + " of shape " + text_of(array.shape) + " at byte " +
                    std::to_string(offset) + " lies outside the " + std::to_string(block.size()) +
                    " bytes",
                compare_versions);
  }
  array.bytes = block.subspan(offset, bytes);
  return array;
}

}  // namespace anticrack::results
