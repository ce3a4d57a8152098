// SPDX-License-Identifier: GPL-3.0-or-later
//
// Structs, numbers, texts and lists as bytes and back.
#pragma once

#include <fmt/core.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "fields/walk.hpp"
#include "mesh/codec.hpp"
#include "stop/stop.hpp"

namespace anticrack::mesh {

static_assert(std::endian::native == std::endian::little,
              "numbers are copied as they lie in memory");

class Writer {
 public:
  /// `bytes`: about how many will be written.
  explicit Writer(std::string_view tag, std::size_t bytes = 0) {
    _bytes.reserve(bytes);
    raw(tag.data(), tag.size());
  }

  /// Writes a number, little-endian as in memory.
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    // -0.0 equals 0.0, so it must not give other bytes
    if constexpr (std::is_floating_point_v<T>) value += T{0};
    raw(&value, sizeof value);
  }
  /// Writes the length of a list or text that follows.
  void count(std::size_t n) { number(static_cast<std::uint64_t>(n)); }
  void text(const std::string& value) {
    count(value.size());
    raw(value.data(), value.size());
  }
  /// Writes numbers, texts, containers and structs with a list of fields, nested at will; the
  /// length of a list comes first.
  template <class T>
  void value(const T& from) {
    if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>) {
      number(static_cast<std::int32_t>(from));
    } else if constexpr (std::is_arithmetic_v<T>) {
      number(from);
    } else if constexpr (std::is_same_v<T, std::string>) {
      text(from);
    } else if constexpr (fields::Listed<const T>) {
      fields::for_each(from, [this](const auto& field) { this->value(field.value); });
    } else if constexpr (fields::is_a<T, std::pair>) {
      value(from.first);
      value(from.second);
    } else if constexpr (fields::is_a<T, std::optional>) {
      value(from.has_value());
      if (from) value(*from);
    } else {
      if constexpr (requires { typename T::allocator_type; }) count(from.size());  // no std::array
      std::size_t turn = 0;
      for (const auto& item : from) {
        stop::look_at_turn<stop::quick>(++turn, "encoding a mesh");
        value(item);
      }
    }
  }

  /// Returns all bytes and empties the writer.
  Bytes take() { return std::move(_bytes); }

 private:
  void raw(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    _bytes.insert(_bytes.end(), first, first + size);
  }

  Bytes _bytes;
};

/// The range of an enum's numbers, and its name in messages.
struct Choices {
  std::int32_t first;
  std::int32_t last;
  const char* what;
};

/// Fewest bytes of an encoded value.
template <class T>
std::size_t least_bytes() {
  std::size_t bytes = 8;  // the length of a text or list
  if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool> || fields::is_a<T, std::optional>) {
    bytes = sizeof(std::int32_t);
  } else if constexpr (std::is_arithmetic_v<T>) {
    bytes = sizeof(T);
  } else if constexpr (fields::Listed<T>) {
    bytes = 0;
    T value;
    fields::for_each(value, [&bytes]<class Value>(const fields::Field<Value>&) {
      bytes += least_bytes<Value>();
    });
  } else if constexpr (requires { std::tuple_size<T>::value; }) {
    bytes = std::tuple_size_v<T> * least_bytes<typename T::value_type>();
  }
  return bytes;
}

class Reader {
 public:
  /// All calls throw errors::Error (mesh_invalid) for bytes that do not fit.
  Reader(std::span<const std::byte> bytes, std::string_view tag) : _bytes(bytes) {
    if (!begins(bytes, tag))
      fail("they do not begin with the tag " + std::string(tag.substr(0, tag.size() - 1)));
    _at = tag.size();
  }

  /// Whether the bytes begin with the tag.
  static bool begins(std::span<const std::byte> bytes, std::string_view tag) noexcept {
    return bytes.size() >= tag.size() && std::memcmp(bytes.data(), tag.data(), tag.size()) == 0;
  }

  /// Reads what Writer::number wrote.
  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    need(sizeof(T));
    T value;
    std::memcpy(&value, _bytes.data() + _at, sizeof value);
    _at += sizeof value;
    return value;
  }
  /// Reads the length of a list whose items take at least `item_bytes` each, and checks it against
  /// the bytes that are left.
  std::size_t count(std::size_t item_bytes) {
    const auto n = number<std::uint64_t>();
    if (n > left() / item_bytes) {
      fail(fmt::format("a list of {} items begins at byte {} of {}", n, _at, _bytes.size()));
    }
    return static_cast<std::size_t>(n);
  }
  /// Reads what Writer::text wrote.
  std::string text() {
    const std::size_t n = count(1);
    std::string value(n, '\0');
    if (n > 0) std::memcpy(value.data(), _bytes.data() + _at, n);
    _at += n;
    return value;
  }
  /// Reads what Writer::value wrote. An enum must be in the range that choices_of() gives for it.
  template <class T>
  void read(T& to) {
    if constexpr (std::is_enum_v<T>) {
      const Choices choices = choices_of(T{});
      to = static_cast<T>(choice(choices.first, choices.last, choices.what));
    } else if constexpr (std::is_same_v<T, bool>) {
      to = choice(0, 1, "a truth value") == 1;
    } else if constexpr (std::is_arithmetic_v<T>) {
      to = number<T>();
    } else if constexpr (std::is_same_v<T, std::string>) {
      to = text();
    } else if constexpr (fields::Listed<T>) {
      fields::for_each(to, [this](const auto& field) { this->read(field.value); });
    } else if constexpr (fields::is_a<T, std::vector>) {
      using Item = typename T::value_type;
      to.resize(count(least_bytes<Item>()));
      if constexpr (std::is_arithmetic_v<Item>) {
        if (to.size() > stop::quick) stop::look("decoding a mesh");
        const std::size_t bytes = to.size() * sizeof(Item);
        if (bytes > 0) std::memcpy(to.data(), _bytes.data() + _at, bytes);
        _at += bytes;
      } else {
        for (Item& item : to) read(item);
      }
    } else if constexpr (fields::is_a<T, std::optional>) {
      bool there = false;
      read(there);
      if (there) read(to.emplace());
    } else if constexpr (fields::is_a<T, std::map>) {
      const auto n =
          count(least_bytes<typename T::key_type>() + least_bytes<typename T::mapped_type>());
      for (std::size_t i = 0; i < n; ++i) {
        typename T::key_type key{};
        read(key);
        read(to[std::move(key)]);
      }
    } else {
      for (auto& item : to) read(item);  // a std::array
    }
  }
  /// Reads a number from `first` to `last`.
  std::int32_t choice(std::int32_t first, std::int32_t last, const char* what) {
    const auto value = number<std::int32_t>();
    if (value < first || value > last) {
      fail(fmt::format("{} is {}; it is {} to {}", what, value, first, last));
    }
    return value;
  }
  /// Throws unless everything was read.
  void end() const {
    if (left() > 0) fail(fmt::format("{} bytes are left over", left()));
  }
  /// Throws errors::Error (mesh_invalid).
  [[noreturn]] static void fail(const std::string& why) {
    throw errors::Error(errors::Reason::mesh_invalid, "these bytes cannot be decoded: {}", why);
  }

 private:
  std::size_t left() const noexcept { return _bytes.size() - _at; }
  void need(std::size_t n) const {
    if (left() < n) fail(fmt::format("they end at byte {}, too early", _bytes.size()));
  }

  std::span<const std::byte> _bytes;
  std::size_t _at = 0;
};

}  // namespace anticrack::mesh
