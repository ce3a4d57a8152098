// SPDX-License-Identifier: GPL-3.0-or-later
//
// Parameters of a statement, in PostgreSQL's binary format.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace anticrack::postgres {

/// A parameter, with its type. Views of texts and bytes must live until the call returns.
class Value {
 public:
  /// A bigint, or a boolean for a bool.
  template <std::integral Number>
  Value(Number number)
      : Value(std::is_same_v<Number, bool> ? boolean : bigint, static_cast<std::int64_t>(number)) {}
  /// A bigint; empty: null.
  Value(const std::optional<std::int64_t>& number) : Value(bigint, number) {}
  Value(std::string_view text) : _type(text_type), _view(text) {}
  Value(const std::string& text) : Value(std::string_view(text)) {}
  Value(const char* text) : Value(std::string_view(text)) {}
  /// text[] and bigint[], for `= any($1)` and unnest($1).
  Value(const std::vector<std::string>& texts);
  Value(const std::vector<std::int64_t>& numbers);
  /// bytea.
  static Value bytes(std::string_view bytes);
  static Value bytes(std::span<const std::byte> bytes);
  /// bytea[].
  static Value list_of_bytes(const std::vector<std::string>& list);

  unsigned type() const noexcept { return _type; }
  /// Null for SQL's null.
  const char* data() const noexcept {
    return _null ? nullptr : _own.empty() ? _view.data() : _own.data();
  }
  std::size_t size() const noexcept { return _own.empty() ? _view.size() : _own.size(); }

 private:
  // Numbers of types, as in pg_type.dat.
  static constexpr unsigned boolean = 16, bytea = 17, bigint = 20, text_type = 25;

  Value(unsigned type, std::optional<std::int64_t> number);
  Value(unsigned type, std::string_view view) : _type(type), _view(view) {}
  Value(unsigned type, unsigned element, const std::vector<std::string>& elements);

  unsigned _type;
  bool _null = false;
  std::string _own;
  std::string_view _view{""};
};

using Values = std::initializer_list<Value>;

}  // namespace anticrack::postgres
