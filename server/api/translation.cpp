// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/translation.hpp"

#include <fmt/core.h>

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <cctype>
#include <limits>
#include <stdexcept>

#include "words/shown.hpp"

namespace anticrack::api {

using errors::Error;
using errors::Reason;

namespace {

/// The values of an enum as text, for example "lumped (1) or consistent (2)" for MASS_UNSPECIFIED =
/// 0, MASS_LUMPED = 1, MASS_CONSISTENT = 2.
std::string choices(const google::protobuf::EnumDescriptor& type) {
  const std::size_t prefix = type.value(0)->name().size() - std::string("UNSPECIFIED").size();
  std::string text;
  for (int i = 1; i < type.value_count(); ++i) {
    text += i == 1 ? "" : i + 1 == type.value_count() ? " or " : ", ";
    for (const char c : type.value(i)->name().substr(prefix))
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    text += fmt::format(" ({})", type.value(i)->number());
  }
  return text;
}

}  // namespace

Error untranslated(std::string_view field) {
  return {Reason::internal, std::string(field) + " is not translated"};
}

const FieldDescriptor& field_of(const Message& message, std::string_view name) {
  const FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(std::string(name));
  if (field == nullptr)
    throw Error(Reason::internal, "{} has no field {}", message.GetTypeName(), name);
  return *field;
}

std::string utf8(const std::string& text) {
  return words::is_utf8(text) ? text : words::printable(text, std::string::npos);
}

void put_number(Message& to, const FieldDescriptor& field, int number) {
  const auto set = field.is_repeated() ? &Reflection::AddEnumValue : &Reflection::SetEnumValue;
  (to.GetReflection()->*set)(&to, &field, number);
}

int get_number(const Message& from, const FieldDescriptor& field, int index) {
  const Reflection& access = *from.GetReflection();
  const int number = index < 0 ? access.GetEnumValue(from, &field)
                               : access.GetRepeatedEnumValue(from, &field, index);
  if (field.enum_type()->FindValueByNumber(number) == nullptr) {
    throw Error(Reason::invalid_argument, "{} {} is unknown; use {}", field.name(), number,
                choices(*field.enum_type()))
        .at(path_of(field, index));
  }
  return number;
}

Message& add(Message& to, const FieldDescriptor& field) {
  const Reflection& access = *to.GetReflection();
  return field.is_repeated() ? *access.AddMessage(&to, &field)
                             : *access.MutableMessage(&to, &field);
}

const Message& message_in(const Message& from, const FieldDescriptor& field, int index) {
  const Reflection& access = *from.GetReflection();
  return index < 0 ? access.GetMessage(from, &field)
                   : access.GetRepeatedMessage(from, &field, index);
}

void require(const Message& from, const FieldDescriptor& field) {
  if (!has(from, field)) throw Error(Reason::invalid_argument, "missing").at(field.name());
}

int size_of(const Message& from, const FieldDescriptor& field) {
  return from.GetReflection()->FieldSize(from, &field);
}

bool has(const Message& from, const FieldDescriptor& field) {
  return from.GetReflection()->HasField(from, &field);
}

std::string serialized(const Message& message) {
  std::string bytes;
  if (message.ByteSizeLong() > std::size_t{std::numeric_limits<int>::max()})
    throw std::length_error("a record is larger than 2 GB");
  google::protobuf::io::StringOutputStream stream(&bytes);
  google::protobuf::io::CodedOutputStream out(&stream);
  out.SetSerializationDeterministic(true);
  message.SerializeToCodedStream(&out);
  out.Trim();
  return bytes;
}

std::string path_of(const FieldDescriptor& field, int index) {
  return index < 0 ? field.name() : fmt::format("{}[{}]", field.name(), index);
}

}  // namespace anticrack::api
