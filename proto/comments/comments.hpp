// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace google::protobuf {
class FieldDescriptor;
}

namespace anticrack::comments {

/// What solve.proto says of a field.
struct Comment {
  std::string text;  ///< behind the field, else above it, as one line
  std::string unit;  ///< in F and L: what stands in brackets at the end of the comment, "F L"
};

/// Of a field of a message of anticrack.v1; empty where the file says nothing.
Comment of(const google::protobuf::FieldDescriptor& field);

}  // namespace anticrack::comments
