// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/json.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver.h>
#include <google/protobuf/util/type_resolver_util.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

std::string json_string(std::string_view text) {
  std::string result = "\"";
  while (true) {
    // After sanitise() only these two need escaping.
    const std::size_t end = text.find_first_of("\n\t");
    for (const char c : sanitise(text.substr(0, end))) {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
    if (end == std::string_view::npos) return result + "\"";
    result += text[end] == '\n' ? "\\n" : "\\t";
    text.remove_prefix(end + 1);
  }
}

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

void JsonWriter::item(std::string_view key) {
  if (_depth > 0) {
    _text += _first ? "\n" : ",\n";
    _text.append(2 * _depth, ' ');
  }
  _first = false;
  if (!key.empty()) _text += json_string(key) + ": ";
}

JsonWriter& JsonWriter::open(std::string_view key, char bracket) {
  item(key);
  _text += bracket;
  ++_depth;
  _first = true;
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  --_depth;
  if (!_first) {
    _text += '\n';
    _text.append(2 * _depth, ' ');
  }
  _text += bracket;
  _first = false;
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view key, std::string_view text) {
  item(key);
  _text += json_string(text);
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view key, double number) {
  item(key);
  if (!std::isfinite(number)) {
    _text += "null";
    return *this;
  }
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  _text.append(buffer.data(), result.ptr);
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view key, std::int64_t number) {
  item(key);
  _text += std::to_string(number);
  return *this;
}

JsonWriter& JsonWriter::element(std::string_view text) { return value({}, text); }

JsonWriter& JsonWriter::texts(std::string_view key, const std::vector<std::string>& texts) {
  begin_array(key);
  for (const std::string& text : texts) element(text);
  return end_array();
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
  return text;
}

}  // namespace anticrack::cli
