// SPDX-License-Identifier: GPL-3.0-or-later
#include "comments/comments.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <regex>
#include <stdexcept>

// The descriptors of the proto files with their comments.
asm(".section .rodata\n"
    ".global anticrack_descriptors\n"
    ".global anticrack_descriptors_end\n"
    "anticrack_descriptors: .incbin \"" ANTICRACK_DESCRIPTORS
    "\"\n"
    "anticrack_descriptors_end:\n"
    ".previous\n");
extern "C" const char anticrack_descriptors, anticrack_descriptors_end;

namespace anticrack::comments {
namespace {

const google::protobuf::DescriptorPool& pool() {
  static const google::protobuf::DescriptorPool& commented = []() -> auto& {
    auto* const made = new google::protobuf::DescriptorPool;  // lives as long as what points to it
    google::protobuf::FileDescriptorSet files;
    const char* const first = &anticrack_descriptors;
    if (!files.ParseFromArray(first, static_cast<int>(&anticrack_descriptors_end - first)))
      throw std::logic_error("the descriptors of the API are damaged");
    for (const auto& file : files.file()) made->BuildFile(file);
    return *made;
  }
  ();
  return commented;
}

}  // namespace

Comment of(const google::protobuf::FieldDescriptor& field) {
  const auto* const commented = pool().FindFieldByName(field.full_name());
  google::protobuf::SourceLocation place;
  if (commented == nullptr || !commented->GetSourceLocation(&place)) return {};
  const std::string& said =
      place.trailing_comments.empty() ? place.leading_comments : place.trailing_comments;
  std::string text = std::regex_replace(said, std::regex("^\\s+|\\s+$"), "");
  text = std::regex_replace(text, std::regex("\\s+"), " ");
  std::smatch parts;
  if (!std::regex_match(text, parts, std::regex("(.*) \\[([FLs/() ^0-9]+)\\]"))) return {text, {}};
  return {parts[1], parts[2]};
}

}  // namespace anticrack::comments
