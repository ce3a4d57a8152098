// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers and words of a .msh file, ascii or binary, with every read checked.
#pragma once

#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace anticrack::mesher {

/// Walks over the bytes of a file. Every failure is an errors::Error (mesh_invalid) that says
/// where.
class MshScanner {
 public:
  explicit MshScanner(std::string_view bytes) noexcept : _bytes(bytes) {}

  /// How the numbers that come are written; text at first.
  void set_binary(bool binary) noexcept { _binary = binary; }
  bool binary() const noexcept { return _binary; }
  /// Named in messages, "$Nodes".
  void enter(std::string section) { _section = std::move(section); }

  /// True when only white space is left.
  bool at_end() noexcept;
  /// The next word between white space; fails at the end of the file.
  std::string_view word();
  /// The rest of the line, its end consumed.
  std::string_view rest_of_line();
  /// Fails unless the next word is this one.
  void expect(std::string_view wanted);
  /// Moves behind the next line that is this word; false if there is none.
  bool skip_past(std::string_view wanted);

  /// A number as text, in binary files too (counts of format 2.2 and the head).
  template <class T>
  T text_number() {
    const std::string_view token = word();
    T value{};
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc{} || end != token.data() + token.size()) not_a_number(token);
    return value;
  }
  /// A number in the format of the file.
  template <class T>
  T number() {
    return _binary ? raw<T>() : text_number<T>();
  }
  /// A number as it is in memory. Fails where the file ends before.
  template <class T>
  T raw() {
    static_assert(std::is_arithmetic_v<T>);
    if (_bytes.size() - _at < sizeof(T)) truncated();
    T value;
    std::memcpy(&value, _bytes.data() + _at, sizeof value);
    _at += sizeof value;
    return value;
  }

  /// Fails unless the rest of the file can hold this many items of `least_bytes` each.
  void require_room(std::size_t count, std::size_t least_bytes) const;

  /// Throw errors::Error (mesh_invalid): the section, the line or byte, and why.
  [[noreturn]] void fail(const std::string& why) const;
  [[noreturn]] void truncated() const;

 private:
  [[noreturn]] void not_a_number(std::string_view token) const;
  void skip_space() noexcept;

  std::string_view _bytes;
  std::size_t _at = 0;
  bool _binary = false;
  std::string _section;
};

/// For messages: at most 32 characters, what is not printable as '?'.
std::string printable(std::string_view text);

}  // namespace anticrack::mesher
