// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/unknown_fields.hpp"

#include <fmt/core.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/unknown_field_set.h>

#include <string>
#include <vector>

#include "errors/errors.hpp"

namespace anticrack::api {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

[[noreturn]] void refuse(const std::string& what, const std::string& path) {
  throw errors::Error(errors::Reason::not_implemented,
                      "{} is unknown to this server, which is older than the client: leave it out, "
                      "or use a newer server",
                      what)
      .at(path);
}

/// Whether a field has an enum or messages; a map counts by its values.
bool has_parts(const FieldDescriptor& field) {
  const FieldDescriptor* of = field.is_map() ? field.message_type()->map_value() : &field;
  return of->cpp_type() == FieldDescriptor::CPPTYPE_ENUM ||
         of->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
}

/// Visits a message. `path` leads to it; empty: it is the request.
void visit(const Message& message, const std::string& path) {
  const auto& reflection = *message.GetReflection();
  const auto& unknown = reflection.GetUnknownFields(message);
  if (!unknown.empty()) {
    refuse(fmt::format("field number {} of {}", unknown.field(0).number(),
                       message.GetDescriptor()->full_name()),
           path);
  }
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (!has_parts(*field)) continue;
    const bool repeated = field->is_repeated();
    const int count = repeated ? reflection.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      std::string below = (path.empty() ? "" : path + ".") + field->name();
      if (repeated) below += fmt::format("[{}]", i);
      if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
        visit(repeated ? reflection.GetRepeatedMessage(message, field, i)
                       : reflection.GetMessage(message, field),
              below);
        continue;
      }
      const int value = repeated ? reflection.GetRepeatedEnumValue(message, field, i)
                                 : reflection.GetEnumValue(message, field);
      if (field->enum_type()->FindValueByNumber(value) == nullptr)
        refuse(fmt::format("value {} of {}", value, field->enum_type()->full_name()), below);
    }
  }
}

}  // namespace

void require_known(const Message& request) { visit(request, ""); }

}  // namespace anticrack::api
