// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

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

}  // namespace anticrack::results
