// SPDX-License-Identifier: GPL-3.0-or-later
#include "log/escape.hpp"

#include <fmt/core.h>
#include <unistr.h>

#include <algorithm>

namespace anticrack::log {
namespace {

/// Control characters, line and paragraph separators, marks of writing direction.
bool is_hidden(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x200E && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-_./:+@,").find(c) != std::string_view::npos;
}

}  // namespace

Character first_character(std::string_view text) {
  ucs4_t code = 0;
  const int bytes =
      u8_mbtoucr(&code, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return bytes > 0 ? Character{code, static_cast<std::size_t>(bytes), true} : Character{};
}

std::string escape(std::string_view value) {
  const bool cut = value.size() > longest_value;
  if (cut) value = value.substr(0, longest_value);
  std::string result;
  result.reserve(value.size() + 16);
  while (!value.empty()) {
    const Character character = first_character(value);
    if (!character.valid) {
      result += "\\ufffd";
    } else if (character.code == '\n') {
      result += "\\n";
    } else if (character.code == '\t') {
      result += "\\t";
    } else if (is_hidden(character.code)) {
      result += fmt::format("\\u{:04x}", character.code);
    } else {
      if (character.code == '"' || character.code == '\\') result += '\\';
      result += value.substr(0, character.bytes);
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
