// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <google/protobuf/message.h>

namespace anticrack::api {

/// Throws errors::Error (not_implemented, field: its path in the request) if the request or a
/// message in it has a field or an enum value that this server does not know. The client is then
/// newer than the server, and an answer that ignores the field would be one to another question.
/// Entries of maps with scalar values are not visited. O(fields).
void require_known(const google::protobuf::Message& request);

}  // namespace anticrack::api
