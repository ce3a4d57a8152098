// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace anticrack::results {

/// What the entries of an array are, in a block and in a file. The first have the numbers of the
/// API's ArrayLayout.Type; there is no text in blocks.
enum class ValueType { float64 = 1, int32, uint8, text };

/// Of double, std::int32_t and enums as large, std::uint8_t, std::string.
template <class T>
inline constexpr ValueType value_type = [] {
  static_assert(std::is_same_v<T, double> || std::is_same_v<T, std::int32_t> ||
                std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::string> ||
                (std::is_enum_v<T> && sizeof(T) == sizeof(std::int32_t)));
  return std::is_same_v<T, double>        ? ValueType::float64
         : std::is_same_v<T, std::string> ? ValueType::text
         : sizeof(T) == 1                 ? ValueType::uint8
                                          : ValueType::int32;
}();

/// For messages: "float64".
const char* name_of(ValueType type);
/// Of an entry; of text those of the pointer to it.
std::size_t bytes_of(ValueType type);

}  // namespace anticrack::results
