// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers and words of a .msh file, ascii or binary, with every read checked.
#pragma once

#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "mesher/messages.hpp"

namespace anticrack::mesher {

/// The least bytes that `numbers` numbers take as text: a digit and a separator each.
constexpr std::size_t text_bytes(std::size_t numbers) noexcept { return 2 * numbers; }

/// A text for messages: at most 32 characters, with '?' for those that cannot be printed.
std::string printable(std::string_view text);

/// Reads the bytes of a file in order. Every failure is an errors::Error (mesh_invalid) that says
/// where.
class MshScanner {
 public:
  /// `file`: the kind of file, for messages.
  explicit MshScanner(std::string_view bytes, const char* file = ".msh file") noexcept
      : _bytes(bytes), _file(file) {}

  /// Sets the format of the numbers that follow, which at first is text.
  void set_binary(bool binary) noexcept { _binary = binary; }
  bool binary() const noexcept { return _binary; }
  /// Sets the section for messages, e.g. "$Nodes".
  void enter(std::string section) { _section = std::move(section); }

  /// Moves past the mark of UTF-8 (BOM) with which some editors begin a file.
  void skip_mark() noexcept;
  /// True when only white space is left.
  bool at_end() noexcept;
  /// The first character of the next word; throws at the end of the file.
  char next();
  /// The next word between white space; throws at the end of the file.
  std::string_view word();
  /// The rest of the line, without its end.
  std::string_view rest_of_line();
  /// Throws unless the next word is this one.
  void expect(std::string_view wanted);
  /// Moves past the next line that begins with this word; false if there is none.
  bool skip_past(std::string_view wanted);

  /// A number as text, also in binary files (counts of format 2.2 and the header).
  template <class T>
  T text_number() {
    const std::string_view token = word();
    // C's printf may write a plus, which from_chars does not accept
    const std::string_view digits = token.substr(token.starts_with('+') ? 1 : 0);
    T value{};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) fail("{} is out of range", printable(token));
    if (error != std::errc{} || end != digits.data() + digits.size())
      fail("expected a number, found \"{}\"", printable(token));
    return value;
  }
  /// A number in the format of the file.
  template <class T>
  T number() {
    return _binary ? raw<T>() : text_number<T>();
  }
  /// A number as in memory, little-endian. Throws at the end of the file.
  template <class T>
  T raw() {
    static_assert(std::is_arithmetic_v<T>);
    if (_bytes.size() - _at < sizeof(T)) truncated();
    T value;
    std::memcpy(&value, _bytes.data() + _at, sizeof value);
    _at += sizeof value;
    return value;
  }

  /// Throws unless the rest of the file can hold `count` items of `least_bytes` each.
  void require_room(std::size_t count, std::size_t least_bytes) const;

  /// Throws errors::Error (mesh_invalid) with the section, the line or byte, and the message.
  template <class... Values>
  [[noreturn]] void fail(fmt::format_string<Values...> message, Values&&... values) const {
    refuse("{}: {}", place(), fmt::format(message, std::forward<Values>(values)...));
  }

 private:
  [[noreturn]] void truncated() const;
  std::string place() const;
  void skip_space() noexcept;

  std::string_view _bytes;
  const char* _file;
  std::size_t _at = 0;
  bool _binary = false;
  std::string _section;
};

}  // namespace anticrack::mesher
