// SPDX-License-Identifier: GPL-3.0-or-later
#include "comments/comments.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <memory>
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
extern "C" const char anticrack_descriptors[], anticrack_descriptors_end[];

namespace anticrack::comments {
namespace {

const google::protobuf::DescriptorPool& pool() {
  static const auto commented = [] {
    auto made = std::make_unique<google::protobuf::DescriptorPool>();
    google::protobuf::FileDescriptorSet files;
    const char* const first = anticrack_descriptors;
    if (!files.ParseFromArray(first, static_cast<int>(anticrack_descriptors_end - first)))
      throw std::logic_error("the descriptors of the API are damaged");
    for (const auto& file : files.file()) made->BuildFile(file);
    return made;
  }();
  return *commented;
}

}  // namespace

Comment of(const google::protobuf::FieldDescriptor& field) {
  const auto* const commented = pool().FindFieldByName(field.full_name());
  google::protobuf::SourceLocation place;
  if (commented == nullptr || !commented->GetSourceLocation(&place)) return {};
  const std::string& said =
      place.trailing_comments.empty() ? place.leading_comments : place.trailing_comments;
  static const std::regex ends("^\\s+|\\s+$"), spaces("\\s+"),
      with_unit("(.*) \\[([FLs/() ^0-9]+)\\]");
  const std::string text = std::regex_replace(std::regex_replace(said, ends, ""), spaces, " ");
  std::smatch parts;
  if (!std::regex_match(text, parts, with_unit)) return {text, {}};
  return {parts[1], parts[2]};
}

}  // namespace anticrack::comments
