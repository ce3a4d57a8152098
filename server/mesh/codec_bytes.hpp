// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers, texts and lists as bytes and back. The reader checks every length against the bytes that
// are left before it allocates.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "mesh/codec.hpp"

namespace anticrack::mesh {

static_assert(std::endian::native == std::endian::little,
              "numbers are copied as they lie in memory");

class Writer {
 public:
  /// `tag` comes first: what the bytes are, in which version.
  explicit Writer(std::string_view tag) { raw(tag.data(), tag.size()); }

  /// Little-endian, as in memory.
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    // -0.0 equals 0.0, so it must not give other bytes
    if constexpr (std::is_floating_point_v<T>) value += T{0};
    raw(&value, sizeof value);
  }
  /// A length of a list or text, which follows it.
  void count(std::size_t n) { number(static_cast<std::uint64_t>(n)); }
  void text(const std::string& value) {
    count(value.size());
    raw(value.data(), value.size());
  }
  /// `write` is called for each item in order.
  template <class Range, class Write>
  void list(const Range& range, Write write) {
    count(range.size());
    for (const auto& item : range) write(item);
  }
  /// Lists of numbers and of texts.
  template <class T>
  void numbers(const std::vector<T>& values) {
    _bytes.reserve(_bytes.size() + 8 + values.size() * sizeof(T));
    list(values, [this](T value) { number(value); });
  }
  /// See numbers().
  void texts(const std::vector<std::string>& values) {
    list(values, [this](const std::string& value) { text(value); });
  }

  /// All of them; the writer is empty then.
  Bytes take() { return std::move(_bytes); }

 private:
  void raw(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    _bytes.insert(_bytes.end(), first, first + size);
  }

  Bytes _bytes;
};

class Reader {
 public:
  /// Every call throws errors::Error (mesh_invalid) where the bytes are not what it asks for.
  Reader(std::span<const std::byte> bytes, std::string_view tag) : _bytes(bytes) {
    if (left() < tag.size() || std::memcmp(_bytes.data(), tag.data(), tag.size()) != 0) {
      fail("they do not begin with the tag " + std::string(tag.substr(0, tag.size() - 1)));
    }
    _at = tag.size();
  }

  /// The next of what Writer::number wrote.
  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    need(sizeof(T));
    T value;
    std::memcpy(&value, _bytes.data() + _at, sizeof value);
    _at += sizeof value;
    return value;
  }
  /// The length of a list whose items take at least `item_bytes` each; what is left bounds it.
  std::size_t count(std::size_t item_bytes) {
    const auto n = number<std::uint64_t>();
    if (n > left() / item_bytes) {
      fail("a list of " + std::to_string(n) + " items begins at byte " + std::to_string(_at) +
           " of " + std::to_string(_bytes.size()));
    }
    return static_cast<std::size_t>(n);
  }
  /// The next of what Writer::text wrote.
  std::string text() {
    const std::size_t n = count(1);
    std::string value(n, '\0');
    if (n > 0) std::memcpy(value.data(), _bytes.data() + _at, n);
    _at += n;
    return value;
  }
  /// The next of what Writer::numbers wrote.
  template <class T>
  std::vector<T> numbers() {
    const std::size_t n = count(sizeof(T));
    std::vector<T> values(n);
    if (n > 0) std::memcpy(values.data(), _bytes.data() + _at, n * sizeof(T));
    _at += n * sizeof(T);
    return values;
  }
  /// What `read` returns for each item of the next list.
  template <class Read>
  auto list(std::size_t item_bytes, Read read) {
    std::vector<decltype(read())> items;
    const std::size_t n = count(item_bytes);
    for (std::size_t i = 0; i < n; ++i) items.push_back(read());
    return items;
  }
  /// The next of what Writer::texts wrote.
  std::vector<std::string> texts() {
    return list(8, [this] { return text(); });
  }
  /// A number from `first` to `last`.
  std::int32_t choice(std::int32_t first, std::int32_t last, const char* what) {
    const auto value = number<std::int32_t>();
    if (value < first || value > last) {
      fail(std::string(what) + " is " + std::to_string(value) + "; it is " + std::to_string(first) +
           " to " + std::to_string(last));
    }
    return value;
  }
  /// Fails unless everything was read.
  void end() const {
    if (left() > 0) fail(std::to_string(left()) + " bytes are left over");
  }
  /// Throws errors::Error (mesh_invalid).
  [[noreturn]] static void fail(const std::string& why) {
    throw errors::Error(errors::Reason::mesh_invalid, "these bytes cannot be decoded: " + why);
  }

 private:
  std::size_t left() const noexcept { return _bytes.size() - _at; }
  void need(std::size_t n) const {
    if (left() < n) fail("they end at byte " + std::to_string(_bytes.size()) + ", too early");
  }

  std::span<const std::byte> _bytes;
  std::size_t _at = 0;
};

}  // namespace anticrack::mesh
