// SPDX-License-Identifier: GPL-3.0-or-later
//
// The single values of the API's messages, as files, tables and JSON name them. They are found by
// walking the message, so that a new field is in all of these by itself.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "results/value_type.hpp"

namespace google::protobuf {
class Descriptor;
class EnumDescriptor;
class FieldDescriptor;
class Message;
}  // namespace google::protobuf

namespace anticrack::results {

using Value = std::variant<double, std::int32_t, std::int64_t, std::string>;

/// A text or number of a message, or what stands for one: of an enum its name ("converged"), of a
/// duration its seconds, of a time its text, of an error its message, of a truth value 0 or 1.
/// Values of a nested message have the name of that one before theirs ("kkt_gap").
struct Entry {
  std::string name;  ///< that of the field; of an inclusion A, B and M as in the paper; seconds
  std::string meaning, unit;                       ///< see comments::Comment
  ValueType type;                                  ///< float64, int32, int64 or text
  const google::protobuf::FieldDescriptor* outer;  ///< of the nested message that has it, or null
  const google::protobuf::FieldDescriptor* field;
};

/// Of a type of message, in the order of its fields, lists and nested messages with lists left out.
const std::vector<Entry>& entries_of(const google::protobuf::Descriptor& type);

/// The one of this name, or null.
const Entry* entry_of(const google::protobuf::Descriptor& type, std::string_view name);

/// The value in a message; of a number that is not set NaN, of anything else that is not 0 or "".
Value get(const google::protobuf::Message& message, const Entry& entry);

/// A float64 by its name; NaN where the message has none.
double number_in(const google::protobuf::Message& message, std::string_view name);

/// Gives a message the value; what stands for none is not set where the field may be unset. False:
/// it is no name of the enum, or no time.
[[nodiscard]] bool set(google::protobuf::Message& message, const Entry& entry, const Value& value);

/// The name of a value of an enum, as "not_converged"; empty where it is none of it.
std::string name_in(const google::protobuf::EnumDescriptor& type, int number);

/// Makes all numbers of a message unknown: NaN, or not set.
void forget_numbers(google::protobuf::Message& message);

}  // namespace anticrack::results
