// SPDX-License-Identifier: GPL-3.0-or-later
//
// The output of --json: a writer for our own tables, whose members keep their order (unlike a
// protobuf Struct), and protobuf's mapping for resources.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace google::protobuf {
class Message;
}

namespace anticrack::cli {

/// Indented by two spaces. Keys are given inside objects and left out inside arrays.
class JsonWriter {
 public:
  /// Begins and ends an object or array, the member `key` inside an object.
  JsonWriter& begin_object(std::string_view key = {}) { return open(key, '{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array(std::string_view key = {}) { return open(key, '['); }
  JsonWriter& end_array() { return close(']'); }
  /// A member or an item; texts are UTF-8.
  JsonWriter& value(std::string_view key, std::string_view text);
  JsonWriter& value(std::string_view key, double number);  ///< null for what is not finite
  JsonWriter& value(std::string_view key, std::int64_t number);
  JsonWriter& element(std::string_view text);
  /// An array of texts.
  JsonWriter& texts(std::string_view key, const std::vector<std::string>& texts);

  const std::string& text() const noexcept { return _text; }

 private:
  JsonWriter& open(std::string_view key, char bracket);
  void item(std::string_view key);
  JsonWriter& close(char bracket);

  std::string _text;
  std::size_t _depth = 0;
  bool _first = true;
};

/// With the proto's own field names, and fields that are zero.
std::string to_json(const google::protobuf::Message& message);

}  // namespace anticrack::cli
