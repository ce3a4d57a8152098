// SPDX-License-Identifier: GPL-3.0-or-later
//
// JSON out of --json: a writer for our own tables (in a fixed order, which a protobuf Struct does
// not have), and protobuf's mapping for resources.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace google::protobuf {
class Message;
}

namespace anticrack::cli {

/// Indented by two spaces. Keys are given inside objects and left out inside arrays.
class JsonWriter {
 public:
  /// An object or array, as a member of that name, until its end.
  JsonWriter& begin_object(std::string_view key = {});
  JsonWriter& end_object();
  JsonWriter& begin_array(std::string_view key = {});
  JsonWriter& end_array();
  /// A member or an item; texts are UTF-8.
  JsonWriter& value(std::string_view key, std::string_view text);
  JsonWriter& value(std::string_view key, double number);  ///< null for what is not finite
  JsonWriter& value(std::string_view key, std::int64_t number);
  JsonWriter& element(std::string_view text);

  const std::string& text() const noexcept { return _text; }

 private:
  void open(std::string_view key);
  void close(char bracket);

  std::string _text;
  std::size_t _depth = 0;
  bool _first = true;
};

/// With the proto's own field names, and fields that are zero.
std::string to_json(const google::protobuf::Message& message);

}  // namespace anticrack::cli
