// SPDX-License-Identifier: GPL-3.0-or-later
//
// The output of --json: of our own tables by nlohmann's library, of resources by protobuf's
// mapping.
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

/// Indented by two spaces, in ASCII, so that no text reaches a terminal as control characters.
/// Numbers that are not finite are null, bytes that are not UTF-8 are replaced.
std::string to_text(const Json& document);

/// With the proto's own field names, and fields that are zero.
std::string to_json(const google::protobuf::Message& message);

}  // namespace anticrack::cli
