// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/text.hpp"

#include "words/shown.hpp"

namespace anticrack::api {

std::string printable(std::string_view text, std::size_t max_bytes) {
  constexpr std::string_view ellipsis = "...";
  std::string result;
  std::size_t room_for_ellipsis = 0;  // longest prefix that leaves room for it
  while (!text.empty()) {
    const words::Character next = words::first_character(text);
    const bool shown = next.valid && !words::is_hidden(next.code);
    const std::string_view piece = shown ? text.substr(0, next.bytes) : "?";
    if (result.size() + piece.size() > max_bytes) {
      result.resize(room_for_ellipsis);
      return result.append(ellipsis);
    }
    result.append(piece);
    if (result.size() + ellipsis.size() <= max_bytes) room_for_ellipsis = result.size();
    text.remove_prefix(next.bytes);
  }
  return result;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const words::Character next = words::first_character(text);
    if (!next.valid) return false;
    text.remove_prefix(next.bytes);
  }
  return true;
}

}  // namespace anticrack::api
