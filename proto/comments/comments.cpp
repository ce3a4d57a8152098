// SPDX-License-Identifier: GPL-3.0-or-later
#include "comments/comments.hpp"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <memory>
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

std::string in_one_line(const std::string& said) {
  constexpr const char* white = " \t\n\v\f\r";
  std::string line;
  for (std::size_t at = said.find_first_not_of(white); at != std::string::npos;) {
    const std::size_t end = std::min(said.find_first_of(white, at), said.size());
    if (!line.empty()) line += ' ';
    line.append(said, at, end - at);
    at = said.find_first_not_of(white, end);
  }
  return line;
}

}  // namespace

Comment of(const google::protobuf::FieldDescriptor& field) {
  const auto* const commented = pool().FindFieldByName(field.full_name());
  google::protobuf::SourceLocation place;
  if (commented == nullptr || !commented->GetSourceLocation(&place)) return {};
  const std::string& said =
      place.trailing_comments.empty() ? place.leading_comments : place.trailing_comments;
  const std::string text = in_one_line(said);
  const std::size_t unit = text.rfind(" [");
  if (unit == std::string::npos || !text.ends_with(']')) return {text, {}};
  const std::string inside = text.substr(unit + 2, text.size() - unit - 3);
  if (inside.empty() || inside.find_first_not_of("FLs/() ^0123456789") != std::string::npos)
    return {text, {}};
  return {text.substr(0, unit), inside};
}

}  // namespace anticrack::comments
