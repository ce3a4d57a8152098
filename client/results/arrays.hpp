// SPDX-License-Identifier: GPL-3.0-or-later
//
// Arrays of numbers by their paths in a result file, "loads/opening/traces/0/jump".
#pragma once

#include <algorithm>
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
#include <type_traits>
#include <utility>
#include <vector>

namespace anticrack::results {

/// Type of the entries of an array, in a block and in a file. The first three have the numbers of
/// the API's ArrayLayout.Type; a block holds no other types.
enum class ValueType { float64 = 1, int32, uint8, int64, text };

/// The ValueType of double, std::int32_t or an enum of its size, std::uint8_t, std::int64_t, or
/// std::string.
template <class T>
inline constexpr ValueType value_type = [] {
  static_assert(std::is_same_v<T, double> || std::is_same_v<T, std::int32_t> ||
                std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::int64_t> ||
                std::is_same_v<T, std::string> ||
                (std::is_enum_v<T> && sizeof(T) == sizeof(std::int32_t)));
  return std::is_same_v<T, double>        ? ValueType::float64
         : std::is_same_v<T, std::string> ? ValueType::text
         : sizeof(T) == 1                 ? ValueType::uint8
         : sizeof(T) == 8                 ? ValueType::int64
                                          : ValueType::int32;
}();

/// The name of a type in messages: "float64".
constexpr const char* name_of(ValueType type) {
  return type == ValueType::float64 ? "float64"
         : type == ValueType::int32 ? "int32"
         : type == ValueType::uint8 ? "uint8"
         : type == ValueType::int64 ? "int64"
                                    : "variable-length text";
}
/// Size of an entry in bytes; a text counts as the pointer to it.
constexpr std::size_t bytes_of(ValueType type) {
  return type == ValueType::int32 ? 4 : type == ValueType::uint8 ? 1 : 8;
}

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
inline bool fits(const Shape& shape, std::string_view wanted, Extents& known) {
  for (const std::uint64_t extent : shape) {
    const std::string word(wanted.substr(0, wanted.find(',')));
    wanted.remove_prefix(std::min(word.size() + 1, wanted.size()));
    const bool number = !word.empty() && word[0] >= '0' && word[0] <= '9';  // of one digit
    if (word.empty() || extent != (number ? static_cast<std::uint64_t>(word[0] - '0')
                                          : known.try_emplace(word, extent).first->second))
      return false;
  }
  return wanted.empty();
}

}  // namespace anticrack::results
