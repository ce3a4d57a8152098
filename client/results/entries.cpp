// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/entries.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/duration.pb.h>
#include <google/protobuf/message.h>
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
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

bool is_of(const FieldDescriptor& field, const Descriptor* type) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && field.message_type() == type;
}

std::string name_of(const FieldDescriptor& field) {
  static const std::pair<std::string, std::string> shorter[]{
      {"displacement", "A"}, {"slope_", "B"}, {"moment_", "M"}};
  std::string name = field.name();
  if (is_of(field, Duration::descriptor())) return name.replace(name.rfind("time"), 4, "seconds");
  if (field.containing_type() != v1::InclusionAnswer::descriptor()) return name;
  for (const auto& [long_name, symbol] : shorter)
    if (name.starts_with(long_name)) return symbol + name.substr(long_name.size());
  return name;
}

ValueType type_of(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return ValueType::float64;
    case FieldDescriptor::CPPTYPE_INT32:
      return ValueType::int32;
    case FieldDescriptor::CPPTYPE_UINT64:
      return ValueType::int64;
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return is_of(field, Duration::descriptor()) ? ValueType::float64 : ValueType::text;
    default:
      return ValueType::text;
  }
}

void add_entries(const Descriptor& type, const FieldDescriptor* outer,
                 std::vector<Entry>& entries) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.is_repeated()) continue;
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE &&
        !is_of(field, Duration::descriptor()) && !is_of(field, v1::Status::descriptor())) {
      add_entries(*field.message_type(), &field, entries);
      continue;
    }
    auto [meaning, unit] = comments::of(field);
    entries.push_back({(outer == nullptr ? "" : outer->name() + "_") + name_of(field),
                       std::move(meaning), std::move(unit), type_of(field), outer, &field});
  }
}

/// "STATUS_NOT_CONVERGED" is "not_converged".
std::string lower_name(const google::protobuf::EnumValueDescriptor& value) {
  const std::string first = value.type()->value(0)->name();  // STATUS_UNSPECIFIED
  std::string name = value.name().substr(first.rfind('_') + 1);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

/// The message that has the value.
const Message& owner(const Message& message, const Entry& entry) {
  return entry.outer == nullptr ? message
                                : message.GetReflection()->GetMessage(message, entry.outer);
}
Message& owner(Message& message, const Entry& entry) {
  return entry.outer == nullptr ? message
                                : *message.GetReflection()->MutableMessage(&message, entry.outer);
}

bool set_enum(Message& message, const FieldDescriptor& field, const std::string& text) {
  for (int i = 0; i < field.enum_type()->value_count(); ++i) {
    const auto* const value = field.enum_type()->value(i);
    if (lower_name(*value) != text) continue;
    message.GetReflection()->SetEnum(&message, &field, value);
    return true;
  }
  return false;
}

Duration duration_of(double seconds) {
  constexpr double most = 9e9;  // in nanoseconds an int64
  return google::protobuf::util::TimeUtil::NanosecondsToDuration(
      std::abs(seconds) <= most ? std::llround(1e9 * seconds) : 0);
}

double seconds_of(const Message& duration) {
  using google::protobuf::util::TimeUtil;
  return static_cast<double>(
             TimeUtil::DurationToNanoseconds(static_cast<const Duration&>(duration))) /
         1e9;
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

const Entry* entry_of(const Descriptor& type, std::string_view name) {
  const std::vector<Entry>& entries = entries_of(type);
  const auto found = std::ranges::find(entries, name, &Entry::name);
  return found == entries.end() ? nullptr : &*found;
}

double number_in(const Message& message, std::string_view name) {
  const Entry* const entry = entry_of(*message.GetDescriptor(), name);
  return entry == nullptr ? std::numeric_limits<double>::quiet_NaN()
                          : std::get<double>(get(message, *entry));
}

Value get(const Message& message, const Entry& entry) {
  const Message& at = owner(message, entry);
  const FieldDescriptor* const field = entry.field;
  const Reflection& fields = *at.GetReflection();
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return field->has_presence() && !fields.HasField(at, field)
                 ? std::numeric_limits<double>::quiet_NaN()
                 : fields.GetDouble(at, field);
    case FieldDescriptor::CPPTYPE_INT32:
      return fields.GetInt32(at, field);
    case FieldDescriptor::CPPTYPE_UINT64:
      return static_cast<std::int64_t>(fields.GetUInt64(at, field));
    case FieldDescriptor::CPPTYPE_ENUM:
      return lower_name(*fields.GetEnum(at, field));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      if (entry.type == ValueType::float64) return seconds_of(fields.GetMessage(at, field));
      return static_cast<const v1::Status&>(fields.GetMessage(at, field)).message();
    default:
      return fields.GetString(at, field);
  }
}

bool set(Message& message, const Entry& entry, const Value& value) {
  Message& at = owner(message, entry);
  const FieldDescriptor* const field = entry.field;
  const Reflection& fields = *at.GetReflection();
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      if (!field->has_presence() || !std::isnan(std::get<double>(value)))
        fields.SetDouble(&at, field, std::get<double>(value));
      return true;
    case FieldDescriptor::CPPTYPE_INT32:
      fields.SetInt32(&at, field, std::get<std::int32_t>(value));
      return true;
    case FieldDescriptor::CPPTYPE_UINT64:
      fields.SetUInt64(&at, field, static_cast<std::uint64_t>(std::get<std::int64_t>(value)));
      return true;
    case FieldDescriptor::CPPTYPE_ENUM:
      return set_enum(at, *field, std::get<std::string>(value));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      if (entry.type == ValueType::float64)
        fields.MutableMessage(&at, field)->CopyFrom(duration_of(std::get<double>(value)));
      else if (const auto& text = std::get<std::string>(value); !text.empty())
        static_cast<v1::Status&>(*fields.MutableMessage(&at, field)).set_message(text);
      return true;
    default:
      fields.SetString(&at, field, std::get<std::string>(value));
      return true;
  }
}

void forget_numbers(Message& message) {
  for (const Entry& entry : entries_of(*message.GetDescriptor())) {
    if (entry.field->cpp_type() != FieldDescriptor::CPPTYPE_DOUBLE) continue;
    Message& at = owner(message, entry);
    at.GetReflection()->ClearField(&at, entry.field);
    static_cast<void>(set(message, entry, std::numeric_limits<double>::quiet_NaN()));
  }
}

}  // namespace anticrack::results
