// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/json.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver.h>
#include <google/protobuf/util/type_resolver_util.h>

#include <memory>
#include <stdexcept>

#include "results/entries.hpp"
#include "words/shown.hpp"

namespace anticrack::cli {
namespace {

constexpr const char* type_prefix = "type.googleapis.com";

/// Types of our messages, and of error details, which have the type names of google.rpc.
class Types : public google::protobuf::util::TypeResolver {
 public:
  using Status = google::protobuf::util::Status;

  Status ResolveMessageType(const std::string& url, google::protobuf::Type* type) override {
    const std::string rpc = std::string(type_prefix) + "/google.rpc.";
    const bool detail = url.rfind(rpc, 0) == 0;
    const std::string ours =
        detail ? std::string(type_prefix) + "/anticrack.v1." + url.substr(rpc.size()) : url;
    const Status status = _known->ResolveMessageType(ours, type);
    if (!status.ok() && detail) {
      // An unknown detail of a newer server: only its name is shown.
      type->Clear();
      type->set_name(url.substr(url.rfind('/') + 1));
      return {};
    }
    return status;
  }

  Status ResolveEnumType(const std::string& url, google::protobuf::Enum* type) override {
    return _known->ResolveEnumType(url, type);
  }

 private:
  std::unique_ptr<google::protobuf::util::TypeResolver> _known{
      google::protobuf::util::NewTypeResolverForDescriptorPool(
          type_prefix, google::protobuf::DescriptorPool::generated_pool())};
};

}  // namespace

Json json_of(const google::protobuf::Message& message, Json json) {
  for (const results::Entry& entry : results::entries_of(*message.GetDescriptor()))
    std::visit([&](const auto& value) { json[entry.name] = value; }, results::get(message, entry));
  return json;
}

Json with_lists(const google::protobuf::Message& message, Json json) {
  for (const auto* list : results::lists_of(*message.GetDescriptor())) {
    Json& items = json[list->name()] = Json::array();
    if (list->message_type() == nullptr) {
      items = results::texts_of(message, *list);
      continue;
    }
    for (const auto* item : results::items_of(message, *list)) items.push_back(json_of(*item));
  }
  return json;
}

std::string to_text(const Json& document) {
  return document.dump(2, ' ', true, Json::error_handler_t::replace);
}

std::string to_json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  Types types;
  const auto status = google::protobuf::util::BinaryToJsonString(
      &types, std::string(type_prefix) + "/" + message.GetTypeName(), message.SerializeAsString(),
      &text, options);
  if (!status.ok()) {
    throw std::runtime_error("cannot write " + message.GetTypeName() +
                             " as JSON: " + std::string(status.message()));
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return words::escaped_in_json(text);
}

}  // namespace anticrack::cli
