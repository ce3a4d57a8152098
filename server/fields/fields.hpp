// SPDX-License-Identifier: GPL-3.0-or-later
//
// The fields of a struct, listed once beside it. Code that handles all of them (messages, records,
// hashes, byte counts, the tests' generators) walks the list.
#pragma once

#include <string_view>
#include <tuple>
#include <type_traits>

namespace anticrack::fields {

/// A field of one value, with its name in the struct and in the API's message.
template <class T>
struct Field {
  std::string_view name;
  T& value;
};
template <class T>
Field(std::string_view, T&) -> Field<T>;

/// A struct with ANTICRACK_FIELDS.
template <class T>
concept Listed = requires(T& value) {
  fields_of(value);
};

/// Calls visit(Field) for each field, in the order of the list.
template <Listed T, class Visit>
void for_each(T& value, Visit&& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, fields_of(value));
}

}  // namespace anticrack::fields

// ANTICRACK_FIELDS(Struct, field, ...) follows a struct, in its namespace. The structured binding
// makes the compiler require all fields.
#define ANTICRACK_FIELDS(Type, ...)                          \
  template <class Struct>                                    \
  requires std::is_same_v<std::remove_const_t<Struct>, Type> \
  auto fields_of(Struct& of) {                               \
    [[maybe_unused]] auto& [__VA_ARGS__] = of;               \
    return std::tuple(ANTICRACK_FIELDS_EACH(__VA_ARGS__));   \
  }

// The preprocessor has no loops: each pass over the text expands one more step.
#define ANTICRACK_FIELDS_EACH(...) ANTICRACK_FIELDS_64(ANTICRACK_FIELDS_STEP(__VA_ARGS__))
#define ANTICRACK_FIELDS_STEP(first, ...) \
  ::anticrack::fields::Field{             \
      #first, of.first} __VA_OPT__(, ANTICRACK_FIELDS_NEXT ANTICRACK_FIELDS_PARENS(__VA_ARGS__))
#define ANTICRACK_FIELDS_NEXT() ANTICRACK_FIELDS_STEP
#define ANTICRACK_FIELDS_PARENS ()
#define ANTICRACK_FIELDS_64(...) \
  ANTICRACK_FIELDS_16(ANTICRACK_FIELDS_16(ANTICRACK_FIELDS_16(ANTICRACK_FIELDS_16(__VA_ARGS__))))
#define ANTICRACK_FIELDS_16(...) \
  ANTICRACK_FIELDS_4(ANTICRACK_FIELDS_4(ANTICRACK_FIELDS_4(ANTICRACK_FIELDS_4(__VA_ARGS__))))
#define ANTICRACK_FIELDS_4(...) \
  ANTICRACK_FIELDS_1(ANTICRACK_FIELDS_1(ANTICRACK_FIELDS_1(ANTICRACK_FIELDS_1(__VA_ARGS__))))
#define ANTICRACK_FIELDS_1(...) __VA_ARGS__
