// SPDX-License-Identifier: GPL-3.0-or-later
#include "log/escape.hpp"

#include <algorithm>

#include "words/shown.hpp"

namespace anticrack::log {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_./:+@,").find(c) != std::string_view::npos;
}

}  // namespace

std::string escape(std::string_view value) {
  const bool cut = value.size() > longest_value;
  if (cut) value = value.substr(0, longest_value);
  std::string result;
  result.reserve(value.size() + 16);
  while (!value.empty()) {
    const words::Character character = words::first_character(value);
    const std::string_view itself = value.substr(0, character.bytes);
    if (character.code == '\n') {
      result += "\\n";
    } else if (character.code == '\t') {
      result += "\\t";
    } else {
      if (character.code == '"' || character.code == '\\') result += '\\';
      result += words::escaped_in_json(itself, {});
    }
    value.remove_prefix(character.bytes);
  }
  return cut ? result + "..." : result;
}

std::string quote_if_needed(std::string_view value) {
  if (!value.empty() && value.size() <= longest_value &&
      std::all_of(value.begin(), value.end(), is_plain))
    return std::string(value);
  return std::string("\"") + escape(value) + "\"";
}

}  // namespace anticrack::log
