// SPDX-License-Identifier: GPL-3.0-or-later
//
// Walks through values made of listed structs, containers, numbers and texts.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "fields/fields.hpp"

namespace anticrack::fields {

/// Whether T is a Container of something, e.g. is_a<T, std::vector>.
template <class T, template <class...> class Container>
inline constexpr bool is_a = false;
template <template <class...> class Container, class... Items>
inline constexpr bool is_a<Container<Items...>, Container> = true;

/// Whether T is an integer, an enum or bool.
template <class T>
concept Whole = std::is_integral_v<T> || std::is_enum_v<T>;

/// Calls sink(leaf) in order with every std::uint64_t (integers, enums, times, lengths of lists,
/// indices of alternatives), double and std::string. Different values give different leaves;
/// targets of shared pointers do not count. O(size).
template <class T, class Sink>
void walk(const T& value, Sink&& sink) {
  const auto number = [&sink](auto whole) { sink(static_cast<std::uint64_t>(whole)); };
  const auto each = [&sink](const auto& items) {
    for (const auto& item : items) walk(item, sink);
  };
  if constexpr (Whole<T>) {
    number(value);
  } else if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::string>) {
    sink(value);
  } else if constexpr (is_a<T, std::chrono::duration>) {
    number(value.count());
  } else if constexpr (is_a<T, std::optional>) {
    number(value.has_value());
    if (value) walk(*value, sink);
  } else if constexpr (is_a<T, std::variant>) {
    number(value.index());
    std::visit([&sink](const auto& held) { walk(held, sink); }, value);
  } else if constexpr (is_a<T, std::vector>) {
    number(value.size());
    each(value);
  } else if constexpr (is_a<T, std::map>) {
    number(value.size());
    for (const auto& [key, item] : value) {
      walk(key, sink);
      walk(item, sink);
    }
  } else if constexpr (Listed<const T>) {
    for_each(value, [&sink](const auto& field) { walk(field.value, sink); });
  } else if constexpr (!is_a<T, std::shared_ptr>) {
    each(value);  // a std::array, whose length is known
  }
}

/// Approximate bytes that the value owns in addition to sizeof. O(size).
template <class T>
std::size_t owned_bytes(const T& value) {
  constexpr std::size_t node = 48;  // overhead of a map's node
  std::size_t bytes = 0;
  if constexpr (std::is_same_v<T, std::string>) {
    bytes = value.size();
  } else if constexpr (is_a<T, std::optional>) {
    if (value) bytes = owned_bytes(*value);
  } else if constexpr (is_a<T, std::variant>) {
    bytes = std::visit([](const auto& held) { return owned_bytes(held); }, value);
  } else if constexpr (is_a<T, std::vector>) {
    bytes = value.size() * sizeof(typename T::value_type);
    if constexpr (!Whole<typename T::value_type> && !std::is_same_v<typename T::value_type, double>)
      for (const auto& item : value) bytes += owned_bytes(item);
  } else if constexpr (is_a<T, std::map>) {
    for (const auto& [key, item] : value)
      bytes += node + sizeof(key) + sizeof(item) + owned_bytes(key) + owned_bytes(item);
  } else if constexpr (Listed<const T>) {
    for_each(value, [&bytes](const auto& field) { bytes += owned_bytes(field.value); });
  }
  return bytes;
}

/// Approximate bytes of the whole value.
template <class T>
std::size_t bytes_of(const T& value) {
  return sizeof(value) + owned_bytes(value);
}

}  // namespace anticrack::fields
