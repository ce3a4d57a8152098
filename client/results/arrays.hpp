// SPDX-License-Identifier: GPL-3.0-or-later
//
// Arrays of numbers by their paths in a result file, "loads/opening/traces/0/jump".
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "results/value_type.hpp"

namespace anticrack::results {

using Shape = std::vector<std::uint64_t>;

/// Number of entries of an array of this shape.
inline std::uint64_t count_of(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

/// Numbers as a server sent them or a file has them, row-major. Copies share them.
struct Array {
  ValueType type = ValueType::float64;  ///< float64, int32 or uint8
  Shape shape{0};
  std::shared_ptr<const std::byte> data{};

  /// The entries. Throws std::logic_error if T is not their type, which is checked where arrays
  /// come from.
  template <class T>
  std::span<const T> as() const {
    if (type != value_type<T>) throw std::logic_error("an array is read as another type");
    return {reinterpret_cast<const T*>(data.get()), count_of(shape)};
  }
};

/// Makes an array of values; `columns`: the extents after the first.
template <class T>
Array array_of(std::vector<T> values, Shape columns = {}) {
  const std::uint64_t width = count_of(columns);
  columns.insert(columns.begin(), width == 0 ? 0 : values.size() / width);
  const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
  return {value_type<T>,
          std::move(columns),
          {owner, reinterpret_cast<const std::byte*>(owner->data())}};
}

using Arrays = std::map<std::string, Array, std::less<>>;

/// The entries of the array at this path; none if there is no such array.
template <class T>
std::span<const T> entries_at(const Arrays& arrays, std::string_view path) {
  const auto found = arrays.find(path);
  return found == arrays.end() ? std::span<const T>() : found->second.as<T>();
}

/// The lengths that the words of shapes stand for in one group of arrays.
using Extents = std::map<std::string, std::uint64_t, std::less<>>;

/// Whether an array of this shape is one of `wanted`, as "rows,inclusions,2"; a word that is not
/// yet in `known` is added.
bool fits(const Shape& shape, std::string_view wanted, Extents& known);

}  // namespace anticrack::results
