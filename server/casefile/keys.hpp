// SPDX-License-Identifier: GPL-3.0-or-later
//
// The keys of cases, a row each. What is written here is what the reader reads, what errors
// suggest, what `anticrack explain` says and what the guide's table is made of. A key whose value
// goes into one field of a message as it is needs no more than its row. Pure.
#pragma once

#include <google/protobuf/descriptor.h>

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anticrack/v1/case.pb.h"

namespace anticrack::casefile {

enum class Type {
  text,
  number,
  positive,  ///< a number above 0; a message's 0 stands for the default, here an absent key
  count,     ///< a whole number from 1
  boolean,
  choice,      ///< the name of a value of the field's enum, in lower case
  time,        ///< seconds, or text with a unit; a Duration
  expression,  ///< or a number
  point,       ///< [x, y]
  table,       ///< of the keys `below`
  list,        ///< of tables of the keys `below`
  structure,   ///< a function of its own reads it
  refused,     ///< known elsewhere; `meaning` says why not here
};

struct Key;
struct Keys;

/// A text of a row that is neither its name nor its meaning.
struct Part {
  std::string_view Key::*member;
  std::string_view text;
};
/// Keys of each entry of a value, by name or index.
struct EachOf {
  const Keys* keys;
};

struct Key {
  std::string_view name;
  Type type = Type::text;
  std::string_view form{};       ///< what is written, where the type does not say
  std::string_view unit{};       ///< L: length, F: force; empty: none
  std::string_view if_absent{};  ///< the default, or what is needed
  /// Path in the message of its Keys that plain types are read into; of a structure only errors
  /// know it. Empty: its name. ".": a table has fields of the message itself.
  std::string_view field{};
  std::string_view meaning{};
  std::string_view need{};  ///< where the key must be there: what to write
  std::string_view only{};  ///< the value of `method` that it belongs to; empty: any
  const Keys* below = nullptr;
  bool many = false;  ///< `below` is of each of its entries, by name or index

  /// The parts in any order: a type, the meaning as a plain text, Parts, the keys below.
  template <class... Parts>
  constexpr Key(std::string_view its_name, const Parts&... parts) : name(its_name) {
    (set(parts), ...);
  }

  std::string_view path() const { return field.empty() ? name : field; }

 private:
  constexpr void set(Type given) { type = given; }
  constexpr void set(std::string_view text) { meaning = text; }
  constexpr void set(Part part) { this->*part.member = part.text; }
  constexpr void set(const Keys* keys) { below = keys; }
  constexpr void set(EachOf each) {
    below = each.keys;
    many = true;
  }
};

/// The keys of a table of a case.
struct Keys {
  const google::protobuf::Descriptor* (*message)();  ///< that the fields are paths in
  std::array<std::span<const Key>, 3> groups;        ///< some are shared by several tables

  const Key* find(std::string_view name) const;  ///< null: there is none
  /// Those that are not refused, in the order of the table.
  std::vector<const Key*> known() const;
  /// The field at the path; null: none.
  const google::protobuf::FieldDescriptor* field(std::string_view path) const;
};

/// Of a whole case; all others are below it.
extern const Keys case_keys;
/// Of a case that is only the mesh of a .msh file: mesh.
extern const Keys msh_keys;

/// The names of the values of an enum as a case has them: MASS_LUMPED is "lumped". Without that of
/// number 0.
std::vector<std::string> choices(const google::protobuf::EnumDescriptor& values);

/// The rows that are meant by a key, "mesh.tip_size", "load.opening.f" or short "tip_size", those
/// directly below included; of an empty one all, in the order of the table. Throws errors::Error:
/// invalid_argument where there is none, with the nearest.
v1::ListCaseKeysResponse list_keys(const v1::ListCaseKeysRequest& request);

}  // namespace anticrack::casefile
