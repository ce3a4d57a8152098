// SPDX-License-Identifier: GPL-3.0-or-later
//
// The output of --json: our own tables by nlohmann's library, resources by protobuf's mapping.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace google::protobuf {
class Message;
}

namespace anticrack::cli {

/// Members keep their order, unlike those of a protobuf Struct.
using Json = nlohmann::ordered_json;

/// The single values of a message by the names of results::Entry, added to `json`.
Json json_of(const google::protobuf::Message& message, Json json = Json::object());

/// The lists of a message by their names, added to `json`: of texts, and of messages as json_of.
Json with_lists(const google::protobuf::Message& message, Json json);

/// The document as text, indented by two spaces and in ASCII, so that no control characters reach a
/// terminal. Numbers that are not finite are null; bytes that are not UTF-8 are replaced.
std::string to_text(const Json& document);

/// A message as JSON, with the proto's field names and including fields that are zero.
std::string to_json(const google::protobuf::Message& message);

}  // namespace anticrack::cli
