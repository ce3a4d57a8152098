// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/json.hpp"

#include <google/protobuf/util/json_util.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

std::string quoted(std::string_view text) {
  // sanitise() leaves valid UTF-8 without control characters: only these two need escaping.
  std::string result = "\"";
  for (const char c : sanitise(text)) {
    if (c == '"' || c == '\\') {
      result += '\\';
    }
    result += c;
  }
  return result + "\"";
}

}  // namespace

void JsonWriter::open(std::string_view key) {
  if (_depth > 0) {
    _text += _first ? "\n" : ",\n";
    _text.append(2 * _depth, ' ');
  }
  _first = false;
  if (!key.empty()) {
    _text += quoted(key) + ": ";
  }
}

void JsonWriter::close(char bracket) {
  --_depth;
  if (!_first) {
    _text += '\n';
    _text.append(2 * _depth, ' ');
  }
  _text += bracket;
  _first = false;
}

JsonWriter& JsonWriter::begin_object(std::string_view key) {
  open(key);
  _text += '{';
  ++_depth;
  _first = true;
  return *this;
}

JsonWriter& JsonWriter::end_object() {
  close('}');
  return *this;
}

JsonWriter& JsonWriter::begin_array(std::string_view key) {
  open(key);
  _text += '[';
  ++_depth;
  _first = true;
  return *this;
}

JsonWriter& JsonWriter::end_array() {
  close(']');
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view key, std::string_view text) {
  open(key);
  _text += quoted(text);
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view key, double number) {
  open(key);
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
  open(key);
  _text += std::to_string(number);
  return *this;
}

JsonWriter& JsonWriter::element(std::string_view text) {
  open({});
  _text += quoted(text);
  return *this;
}

std::string to_json(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(message, &text, options);
  if (!status.ok()) {
    throw std::runtime_error("cannot write " + message.GetTypeName() +
                             " as JSON: " + std::string(status.message()));
  }
  while (!text.empty() && text.back() == '\n') {
    text.pop_back();
  }
  return text;
}

}  // namespace anticrack::cli
