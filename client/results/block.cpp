// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/block.hpp"

#include <fmt/format.h>

#include "results/entries.hpp"
#include "results/result.hpp"

namespace anticrack::results {
namespace {

/// The shape of an array in messages: "(3,2)".
std::string text_of(const v1::ArrayLayout& array) {
  return fmt::format("({})", fmt::join(array.shape(), ","));
}

}  // namespace

Block::Block(std::string subject, const BlockView& view)
    : _subject(std::move(subject)), _bytes(view.bytes) {
  for (const v1::ArrayLayout& array : view.layout.arrays())
    if (!_arrays.emplace(array.name(), &array).second) fail("array " + array.name() + " twice");
}

bool Block::has_below(const std::string& prefix) const {
  const auto found = _arrays.lower_bound(prefix);
  return found != _arrays.end() && found->first.starts_with(prefix);
}

void Block::fail(const std::string& cause) const {
  throw Error(_subject, cause,
              "the server and this client do not understand each other: compare their versions "
              "with `anticrack server`");
}

std::span<const std::byte> Block::bytes_of(const std::string& name, ValueType type,
                                           std::uint64_t columns, std::uint64_t rows,
                                           std::uint64_t depth) const {
  const auto found = _arrays.find(name);
  if (found == _arrays.end()) fail("array " + name + " is missing");
  const v1::ArrayLayout& array = *found->second;
  if (static_cast<int>(array.type()) != static_cast<int>(type)) {
    fail("array " + name + " is " + name_in(*v1::ArrayLayout::Type_descriptor(), array.type()) +
         ", not " + name_of(type));
  }
  const auto& shape = array.shape();
  const bool by_rows = columns == arrays::named;
  const bool fits = shape.size() == (columns == 0 ? 1 : 2) + (depth > 1 ? 1 : 0) &&
                    (columns == 0 || (by_rows ? shape[0] == rows : shape[1] == columns)) &&
                    (depth == 1 || shape[shape.size() - 1] == depth);
  if (!fits) {
    fail("array " + name + " has shape " + text_of(array) + ", not (" +
         (by_rows ? fmt::format("{},", rows) : "") + "n" +
         (by_rows || columns == 0 ? "" : fmt::format(",{}", columns)) +
         (depth == 1 ? "" : fmt::format(",{}", depth)) + ")");
  }
  std::uint64_t size = results::bytes_of(type);
  bool inside = array.offset() <= _bytes.size();
  for (const std::uint64_t extent : shape)
    inside = inside && !__builtin_mul_overflow(size, extent, &size);
  if (!inside || size > _bytes.size() - array.offset()) {
    fail(fmt::format("array {} of shape {} at byte {} lies outside the {} bytes", name,
                     text_of(array), array.offset(), _bytes.size()));
  }
  return _bytes.subspan(array.offset(), size);
}

}  // namespace anticrack::results
