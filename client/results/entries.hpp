// SPDX-License-Identifier: GPL-3.0-or-later
//
// The single values of the API's messages, as files, tables and JSON name them. They are found by
// walking the message type, so that a new field appears in all of these by itself.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "results/arrays.hpp"

namespace google::protobuf {
class Descriptor;
class EnumDescriptor;
class FieldDescriptor;
class Message;
}  // namespace google::protobuf

namespace anticrack::results {

using Value = std::variant<double, std::int32_t, std::int64_t, std::string>;

/// A text or number of a message. An enum is given by its name ("converged"), a duration by its
/// seconds, a time by its text, an error by its message, a truth value by 0 or 1. The name of a
/// value in a nested message begins with the nested message's name ("kkt_gap").
struct Entry {
  std::string name;  ///< the field's, but A, B, M of inclusions as in the paper, G1 and Gc of
                     ///< growth, times in seconds
  std::string meaning, unit;                       ///< see comments::Comment
  ValueType type;                                  ///< float64, int32, int64 or text
  const google::protobuf::FieldDescriptor* outer;  ///< the nested message with the field, or null
  const google::protobuf::FieldDescriptor* field;
};

/// The entries of a message type in field order, without lists and nested messages with lists.
const std::vector<Entry>& entries_of(const google::protobuf::Descriptor& type);

/// The lists of a message type.
std::vector<const google::protobuf::FieldDescriptor*> lists_of(
    const google::protobuf::Descriptor& type);

/// The messages of a list.
std::vector<const google::protobuf::Message*> items_of(
    const google::protobuf::Message& message, const google::protobuf::FieldDescriptor& list);

/// The texts of a list.
std::vector<std::string> texts_of(const google::protobuf::Message& message,
                                  const google::protobuf::FieldDescriptor& list);

/// The entry of this name, or null.
const Entry* entry_of(const google::protobuf::Descriptor& type, std::string_view name);

/// The value in a message; if it is not set, NaN for a float64, else 0 or "".
Value get(const google::protobuf::Message& message, const Entry& entry);

/// The float64 of this name; NaN if the message type has no such entry or the value is not set.
double number_in(const google::protobuf::Message& message, std::string_view name);

/// Sets the value in a message. A value that means "not set" leaves the field unset if the field
/// can be unset. Returns false if the text is no name of the enum, or no time.
[[nodiscard]] bool set(google::protobuf::Message& message, const Entry& entry, const Value& value);

/// The name of an enum's value, as "not_converged"; empty if the enum has no such number.
std::string name_in(const google::protobuf::EnumDescriptor& type, int number);

/// Makes all numbers of a message unknown: they become NaN, or are no longer set.
void forget_numbers(google::protobuf::Message& message);

}  // namespace anticrack::results
