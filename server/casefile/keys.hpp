// SPDX-License-Identifier: GPL-3.0-or-later
//
// The keys of cases, a row each. The reader, the suggestions of errors, `anticrack explain` and the
// guide's table are all made from these rows. A key whose value goes unchanged into one field of a
// message needs nothing but its row. Pure.
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
  expression,  ///< an expression, or a number
  point,       ///< [x, y]
  table,       ///< a table of the keys `below`
  list,        ///< a list of tables of the keys `below`
  structure,   ///< a function of its own reads it
  refused,     ///< a key that is known elsewhere; `meaning` says why it is not allowed here
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
  std::string_view form{};       ///< the form of the value, if the type does not tell
  std::string_view unit{};       ///< L: length, F: force; empty: none
  std::string_view if_absent{};  ///< the default, or what is needed instead
  /// Path of the field, in the message of its Keys, into which a plain type is read; for a
  /// structure only errors use it. Empty: the key's name. ".": a table whose keys are fields of the
  /// message itself.
  std::string_view field{};
  std::string_view meaning{};
  std::string_view need{};  ///< if the key must be present: what to write
  std::string_view only{};  ///< the value of `method` to which it belongs; empty: any
  const Keys* below = nullptr;
  bool many = false;  ///< it has entries, by name or index, with the keys `below`

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
  const google::protobuf::Descriptor* (*message)();  ///< the message in which the fields are paths
  std::array<std::span<const Key>, 3> groups;        ///< some are shared by several tables

  const Key* find(std::string_view name) const;  ///< null if there is none
  /// The keys that are not refused, in the order of the table.
  std::vector<const Key*> known() const;
  /// The field at the path; null if there is none.
  const google::protobuf::FieldDescriptor* field(std::string_view path) const;
};

/// The keys of a whole case; all other keys are below these.
extern const Keys case_keys;
/// The keys of a case that is only the mesh of a .msh file: mesh.
extern const Keys msh_keys;

/// The names of an enum's values in a case, without the value of number 0: MASS_LUMPED is "lumped".
std::vector<std::string> choices(const google::protobuf::EnumDescriptor& values);

/// The rows that a key means, "mesh.tip_size", "load.opening.f" or in short "tip_size", with the
/// rows directly below; for an empty key all rows, in the order of the table. Throws errors::Error
/// (invalid_argument), with the nearest key, if there is none.
v1::ListCaseKeysResponse list_keys(const v1::ListCaseKeysRequest& request);

}  // namespace anticrack::casefile
