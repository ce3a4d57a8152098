// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/entries.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/duration.pb.h>
#include <google/protobuf/message.h>
#include <google/protobuf/reflection.h>
#include <google/protobuf/timestamp.pb.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "anticrack/v1/solve.pb.h"
#include "comments/comments.hpp"

namespace anticrack::results {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::Duration;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;
using google::protobuf::Timestamp;
using google::protobuf::util::TimeUtil;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool is_message(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
}

bool is_duration(const FieldDescriptor& field) {
  return is_message(field) && field.message_type() == Duration::descriptor();
}

/// Whether the field is a message whose values are entries of their own.
bool is_nested(const FieldDescriptor& field) {
  return is_message(field) && !is_duration(field) &&
         field.message_type() != Timestamp::descriptor() &&
         field.message_type() != v1::Status::descriptor();
}

std::string name_of(const FieldDescriptor& field) {
  static const std::pair<std::string, std::string> shorter[]{{"displacement", "A"},
                                                             {"slope_", "B"},
                                                             {"moment_", "M"},
                                                             {"k_iii", "K_III"},
                                                             {"energy_release_rate", "G"}};
  std::string name = field.name();
  if (is_duration(field)) return name.replace(name.rfind("time"), 4, "seconds");
  if (field.containing_type() == v1::GrowthRow::descriptor())
    return name.starts_with("g1") || name == "g_dead" ? "G" + name.substr(1)
           : name == "toughness"                      ? "Gc"
                                                      : name;
  if (field.containing_type() != v1::InclusionAnswer::descriptor() &&
      field.containing_type() != v1::BoundaryAnswer::descriptor() &&
      field.containing_type() != v1::Tip::descriptor())
    return name;
  for (const auto& [long_name, symbol] : shorter)
    if (name.starts_with(long_name)) return symbol + name.substr(long_name.size());
  return name;
}

ValueType type_of(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return ValueType::float64;
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_BOOL:
      return ValueType::int32;
    case FieldDescriptor::CPPTYPE_UINT64:
      return ValueType::int64;
    default:
      return is_duration(field) ? ValueType::float64 : ValueType::text;
  }
}

void add_entries(const Descriptor& type, const FieldDescriptor* outer,
                 std::vector<Entry>& entries) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.is_repeated()) continue;
    if (!is_nested(field)) {
      auto [meaning, unit] = comments::of(field);
      entries.push_back({(outer == nullptr ? "" : outer->name() + "_") + name_of(field),
                         std::move(meaning), std::move(unit), type_of(field), outer, &field});
    } else if (outer == nullptr && lists_of(*field.message_type()).empty()) {
      add_entries(*field.message_type(), &field, entries);
    }
  }
}

/// The value that means "not set".
Value none_of(const Entry& entry) {
  switch (entry.type) {
    case ValueType::float64:
      return is_message(*entry.field) ? 0.0 : nan;
    case ValueType::int32:
      return std::int32_t{0};
    case ValueType::int64:
      return std::int64_t{0};
    default:
      return std::string();
  }
}

bool is_none(const Value& value, const Entry& entry) {
  const auto* const number = std::get_if<double>(&value);
  return value == none_of(entry) || (number != nullptr && std::isnan(*number));
}

/// The message that has the entry's field: `message` itself or one nested in it.
const Message& owner(const Message& message, const Entry& entry) {
  return entry.outer == nullptr ? message
                                : message.GetReflection()->GetMessage(message, entry.outer);
}
Message& owner(Message& message, const Entry& entry) {
  return entry.outer == nullptr ? message
                                : *message.GetReflection()->MutableMessage(&message, entry.outer);
}

/// The value of a duration, a time or an error, see Entry.
Value value_of(const Message& message) {
  if (const auto* const duration = dynamic_cast<const Duration*>(&message))
    return static_cast<double>(TimeUtil::DurationToNanoseconds(*duration)) / 1e9;
  if (const auto* const time = dynamic_cast<const Timestamp*>(&message))
    return TimeUtil::ToString(*time);
  return dynamic_cast<const v1::Status&>(message).message();
}

bool set_message(Message& message, const Value& value) {
  if (auto* const duration = dynamic_cast<Duration*>(&message)) {
    constexpr double most = 9e9;  // so that the nanoseconds fit an int64
    const double seconds = std::get<double>(value);
    *duration = TimeUtil::NanosecondsToDuration(
        std::abs(seconds) <= most ? std::llround(1e9 * seconds) : 0);
    return true;
  }
  const auto& text = std::get<std::string>(value);
  if (auto* const time = dynamic_cast<Timestamp*>(&message))
    return TimeUtil::FromString(text, time);
  dynamic_cast<v1::Status&>(message).set_message(text);
  return true;
}

bool set_enum(Message& message, const FieldDescriptor& field, const std::string& text) {
  const EnumDescriptor& type = *field.enum_type();
  for (int i = 0; i < type.value_count(); ++i) {
    const int number = type.value(i)->number();
    if (name_in(type, number) != text) continue;
    message.GetReflection()->SetEnumValue(&message, &field, number);
    return true;
  }
  return false;
}

}  // namespace

const std::vector<Entry>& entries_of(const Descriptor& type) {
  static std::mutex mutex;
  static std::map<const Descriptor*, std::vector<Entry>> known;
  const std::scoped_lock lock(mutex);
  std::vector<Entry>& entries = known[&type];
  if (entries.empty()) add_entries(type, nullptr, entries);
  return entries;
}

std::vector<const FieldDescriptor*> lists_of(const Descriptor& type) {
  std::vector<const FieldDescriptor*> lists;
  for (int i = 0; i < type.field_count(); ++i)
    if (type.field(i)->is_repeated()) lists.push_back(type.field(i));
  return lists;
}

std::vector<const Message*> items_of(const Message& message, const FieldDescriptor& list) {
  std::vector<const Message*> items;
  const Reflection& fields = *message.GetReflection();
  for (int i = 0; i < fields.FieldSize(message, &list); ++i)
    items.push_back(&fields.GetRepeatedMessage(message, &list, i));
  return items;
}

std::vector<std::string> texts_of(const Message& message, const FieldDescriptor& list) {
  const auto& texts = message.GetReflection()->GetRepeatedFieldRef<std::string>(message, &list);
  return {texts.begin(), texts.end()};
}

const Entry* entry_of(const Descriptor& type, std::string_view name) {
  const std::vector<Entry>& entries = entries_of(type);
  const auto found = std::ranges::find(entries, name, &Entry::name);
  return found == entries.end() ? nullptr : &*found;
}

double number_in(const Message& message, std::string_view name) {
  const Entry* const entry = entry_of(*message.GetDescriptor(), name);
  return entry == nullptr ? nan : std::get<double>(get(message, *entry));
}

std::string name_in(const EnumDescriptor& type, int number) {
  const auto* const value = type.FindValueByNumber(number);
  if (value == nullptr) return {};
  const std::string first = type.value(0)->name();  // STATUS_UNSPECIFIED
  std::string name = value->name().substr(first.rfind('_') + 1);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

Value get(const Message& message, const Entry& entry) {
  const Message& at = owner(message, entry);
  const FieldDescriptor* const field = entry.field;
  const Reflection& fields = *at.GetReflection();
  const bool is_set =
      (entry.outer == nullptr || message.GetReflection()->HasField(message, entry.outer)) &&
      (!field->has_presence() || fields.HasField(at, field));
  if (!is_set) return none_of(entry);
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return fields.GetDouble(at, field);
    case FieldDescriptor::CPPTYPE_INT32:
      return fields.GetInt32(at, field);
    case FieldDescriptor::CPPTYPE_BOOL:
      return std::int32_t{fields.GetBool(at, field)};
    case FieldDescriptor::CPPTYPE_UINT64:
      return static_cast<std::int64_t>(fields.GetUInt64(at, field));
    case FieldDescriptor::CPPTYPE_ENUM:
      return name_in(*field->enum_type(), fields.GetEnumValue(at, field));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return value_of(fields.GetMessage(at, field));
    default:
      return fields.GetString(at, field);
  }
}

bool set(Message& message, const Entry& entry, const Value& value) {
  const FieldDescriptor* const field = entry.field;
  if ((entry.outer != nullptr || field->has_presence()) && is_none(value, entry)) return true;
  Message& at = owner(message, entry);
  const Reflection& fields = *at.GetReflection();
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      fields.SetDouble(&at, field, std::get<double>(value));
      return true;
    case FieldDescriptor::CPPTYPE_INT32:
      fields.SetInt32(&at, field, std::get<std::int32_t>(value));
      return true;
    case FieldDescriptor::CPPTYPE_BOOL:
      fields.SetBool(&at, field, std::get<std::int32_t>(value) != 0);
      return true;
    case FieldDescriptor::CPPTYPE_UINT64:
      fields.SetUInt64(&at, field, static_cast<std::uint64_t>(std::get<std::int64_t>(value)));
      return true;
    case FieldDescriptor::CPPTYPE_ENUM:
      return set_enum(at, *field, std::get<std::string>(value));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return set_message(*fields.MutableMessage(&at, field), value);
    default:
      fields.SetString(&at, field, std::get<std::string>(value));
      return true;
  }
}

void forget_numbers(Message& message) {
  const Reflection& fields = *message.GetReflection();
  for (const Entry& entry : entries_of(*message.GetDescriptor())) {
    if (entry.field->cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) continue;
    if (entry.outer != nullptr || entry.field->has_presence())
      fields.ClearField(&message, entry.outer != nullptr ? entry.outer : entry.field);
    else
      fields.SetDouble(&message, entry.field, nan);
  }
}

}  // namespace anticrack::results
