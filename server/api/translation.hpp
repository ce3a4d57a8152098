// SPDX-License-Identifier: GPL-3.0-or-later
//
// Translates structs to messages of the API and back: each listed field of a struct
// (fields/fields.hpp) is the field of the message with the same name. translations.hpp specialises
// Translation for other shapes. A field that the message lacks fails at the first use.
#pragma once

#include <google/protobuf/message.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "fields/walk.hpp"

namespace anticrack::api {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
/// Fields that the caller translates.
using Except = std::initializer_list<std::string_view>;

template <fields::Listed T>
void write_fields(const T& value, Message& to, Except except = {});
/// Throws errors::Error (invalid_argument) with the field at fault, as a path in the message.
template <fields::Listed T>
void read_fields(const Message& from, T& value, Except except = {});

/// Translates a value to a message of type `Of`. Specialised where fields differ.
template <class T>
struct Translation {};
template <fields::Listed T>
struct Translation<T> {
  using Of = Message;
  static void write(const T& value, Message& to) { write_fields(value, to); }
  static T read(const Message& from) {
    T value;
    read_fields(from, value);
    return value;
  }
};

/// A field of the message. Throws errors::Error (internal) if there is none.
const FieldDescriptor& field_of(const Message& message, std::string_view name);

/// Reflection's methods for a number or text of type T.
template <class T>
struct Access;
#define ANTICRACK_ACCESS(Type, Name)                                     \
  template <>                                                            \
  struct Access<Type> {                                                  \
    static constexpr auto set = &Reflection::Set##Name;                  \
    static constexpr auto add = &Reflection::Add##Name;                  \
    static constexpr auto get = &Reflection::Get##Name;                  \
    static constexpr auto get_repeated = &Reflection::GetRepeated##Name; \
  }
ANTICRACK_ACCESS(bool, Bool);
ANTICRACK_ACCESS(double, Double);
ANTICRACK_ACCESS(std::int32_t, Int32);
ANTICRACK_ACCESS(std::uint32_t, UInt32);
ANTICRACK_ACCESS(std::uint64_t, UInt64);
ANTICRACK_ACCESS(std::string, String);
#undef ANTICRACK_ACCESS

/// Sets a number or text of a message, or appends it to a list.
template <class T>
void put(Message& to, const FieldDescriptor& field, T value) {
  const auto set = field.is_repeated() ? Access<T>::add : Access<T>::set;
  (to.GetReflection()->*set)(&to, &field, std::move(value));
}
/// `index` -1: the field is not a list.
template <class T>
T get(const Message& from, const FieldDescriptor& field, int index) {
  const Reflection& access = *from.GetReflection();
  return index < 0 ? (access.*Access<T>::get)(from, &field)
                   : (access.*Access<T>::get_repeated)(from, &field, index);
}
/// The text with '?' for invalid UTF-8, which messages cannot hold.
std::string utf8(const std::string& text);
/// The number of an enum. Reading throws errors::Error for a number that the API does not have.
void put_number(Message& to, const FieldDescriptor& field, int number);
int get_number(const Message& from, const FieldDescriptor& field, int index);
/// The message in a field; a new one if the field is a list.
Message& add(Message& to, const FieldDescriptor& field);
/// The message in a field, a default one if it is not set. `index`: -1 if the field is not a list.
const Message& message_in(const Message& from, const FieldDescriptor& field, int index);
/// Throws errors::Error unless the field is set.
void require(const Message& from, const FieldDescriptor& field);
int size_of(const Message& from, const FieldDescriptor& field);
bool has(const Message& from, const FieldDescriptor& field);
/// The error (internal) for a field without translation.
errors::Error untranslated(std::string_view field);
/// The path of a field: "name" or "name[2]".
std::string path_of(const FieldDescriptor& field, int index);

template <class T>
concept Simple = fields::Whole<T> || std::is_same_v<T, double> || std::is_same_v<T, std::string>;

template <class T>
void write_one(const T& value, Message& to, const FieldDescriptor& field) {
  if constexpr (std::is_enum_v<T>) {
    put_number(to, field, static_cast<int>(value));
  } else if constexpr (std::is_same_v<T, std::string>) {
    put(to, field, utf8(value));
  } else if constexpr (Simple<T>) {
    put(to, field, value);
  } else {
    using Of = typename Translation<T>::Of;
    Translation<T>::write(value, static_cast<Of&>(add(to, field)));
  }
}

template <class T>
T read_one(const Message& from, const FieldDescriptor& field, int index = -1) {
  if constexpr (std::is_enum_v<T>) {
    return static_cast<T>(get_number(from, field, index));
  } else if constexpr (Simple<T>) {
    return get<T>(from, field, index);
  } else {
    using Of = typename Translation<T>::Of;
    if constexpr (requires { Translation<T>::required; }) {
      if (index < 0) require(from, field);
    }
    try {
      return Translation<T>::read(static_cast<const Of&>(message_in(from, field, index)));
    } catch (errors::Error& error) {
      error.below(path_of(field, index));
      throw;
    }
  }
}

template <class T>
void write_field(const T& value, Message& to, const FieldDescriptor& field) {
  if constexpr (fields::is_a<T, std::optional>) {
    if (value) write_one(*value, to, field);
  } else if constexpr (fields::is_a<T, std::vector>) {
    for (const auto& item : value) write_one(item, to, field);
  } else if constexpr (fields::is_a<T, std::map>) {
    for (const auto& [key, item] : value) {
      Message& entry = add(to, field);
      write_one(key, entry, field_of(entry, "key"));
      write_one(item, entry, field_of(entry, "value"));
    }
  } else {
    write_one(value, to, field);
  }
}

/// Reads a value; leaves it unchanged if the message does not set an optional number or an enum.
template <class T>
void read_field(const Message& from, const FieldDescriptor& field, T& value) {
  if constexpr (fields::is_a<T, std::optional>) {
    if (has(from, field)) value.emplace(read_one<typename T::value_type>(from, field));
  } else if constexpr (fields::is_a<T, std::vector>) {
    const int count = size_of(from, field);
    value.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
      value.push_back(read_one<typename T::value_type>(from, field, i));
  } else if constexpr (fields::is_a<T, std::map>) {
    for (int i = 0, count = size_of(from, field); i < count; ++i) {
      const Message& entry = message_in(from, field, i);
      value[read_one<typename T::key_type>(entry, field_of(entry, "key"))] =
          read_one<typename T::mapped_type>(entry, field_of(entry, "value"));
    }
  } else if constexpr (Simple<T>) {
    const bool silent = (std::is_enum_v<T> || field.has_presence()) && !has(from, field);
    if (!silent) value = read_one<T>(from, field);
  } else {
    value = read_one<T>(from, field);
  }
}

/// Types whose fields are translated; fields of other types must be exceptions of their struct.
template <class T>
concept Translated = Simple<T> || fields::is_a<T, std::optional> || fields::is_a<T, std::vector> ||
    fields::is_a<T, std::map> || requires {
  typename Translation<T>::Of;
};

template <fields::Listed T>
void write_fields(const T& value, Message& to, Except except) {
  fields::for_each(value, [&]<class Value>(const fields::Field<Value>& each) {
    if (std::find(except.begin(), except.end(), each.name) != except.end()) return;
    if constexpr (Translated<std::remove_const_t<Value>>)
      write_field(each.value, to, field_of(to, each.name));
    else
      throw untranslated(each.name);
  });
}

template <fields::Listed T>
void read_fields(const Message& from, T& value, Except except) {
  fields::for_each(value, [&]<class Value>(const fields::Field<Value>& each) {
    if (std::find(except.begin(), except.end(), each.name) != except.end()) return;
    if constexpr (Translated<Value>)
      read_field(from, field_of(from, each.name), each.value);
    else
      throw untranslated(each.name);
  });
}

/// Writes one field, by its name.
template <class T>
void write_field(const T& value, Message& to, std::string_view name) {
  write_field(value, to, field_of(to, name));
}
/// Reads one field, by its name.
template <class T>
void read_field(const Message& from, std::string_view name, T& value) {
  read_field(from, field_of(from, name), value);
}
/// The value of the field, or the default if it is not set.
template <class T>
T read_one(const Message& from, std::string_view name) {
  return read_one<T>(from, field_of(from, name));
}

/// Deterministic bytes of a message. Throws std::length_error beyond 2 GB.
std::string serialized(const Message& message);

/// Makes the message of a value's Translation.
template <class T>
typename Translation<T>::Of message(const T& value) {
  typename Translation<T>::Of to;
  Translation<T>::write(value, to);
  return to;
}

}  // namespace anticrack::api
