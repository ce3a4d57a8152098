// SPDX-License-Identifier: GPL-3.0-or-later
#include "words/shown.hpp"

#include <unictype.h>
#include <unistr.h>

#include <array>
#include <cstdio>

namespace anticrack::words {
namespace {

/// Passes every character on, and `replace(character)` instead of a hidden one.
template <class Replace>
std::string each(std::string_view text, std::string_view keep, const Replace& replace) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character next = first_character(text);
    const std::string_view itself = text.substr(0, next.bytes);
    const bool plain = next.valid && !is_hidden(next.code);
    result +=
        plain || keep.find(itself) != std::string_view::npos ? std::string(itself) : replace(next);
    text.remove_prefix(next.bytes);
  }
  return result;
}

}  // namespace

Character first_character(std::string_view text) {
  ucs4_t code = 0;
  const int bytes =
      u8_mbtoucr(&code, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  return bytes > 0 ? Character{code, static_cast<std::size_t>(bytes), true} : Character{};
}

bool is_hidden(std::uint32_t code) {
  if (code >= 0x20 && code < 0x7F) return false;
  constexpr std::uint32_t separators = UC_CATEGORY_MASK_Zl | UC_CATEGORY_MASK_Zp;
  constexpr std::uint32_t hidden = UC_CATEGORY_MASK_Cc | UC_CATEGORY_MASK_Cf | separators;
  return uc_is_general_category_withtable(code, hidden) ||
         uc_is_property_default_ignorable_code_point(code);
}

std::string shown(std::string_view text, std::string_view keep) {
  return each(text, keep, [](const Character&) { return std::string("?"); });
}

std::string escaped_in_json(std::string_view json, std::string_view keep) {
  return each(json, keep, [](const Character& hidden) {
    std::uint32_t code = hidden.valid ? hidden.code : 0xFFFD;
    std::string text;
    std::array<char, 16> unit{};
    const auto add = [&](std::uint32_t value) {
      std::snprintf(unit.data(), unit.size(), "\\u%04x", value);
      text += unit.data();
    };
    constexpr std::uint32_t beyond = 0x10000;
    if (code < beyond) {
      add(code);
    } else {  // as a pair of surrogates
      code -= beyond;
      add(0xD800 + (code >> 10));
      add(0xDC00 + (code & 0x3FF));
    }
    return text;
  });
}

std::string printable(std::string_view text, std::size_t max_bytes) {
  constexpr std::string_view ellipsis = "...";
  std::string result;
  std::size_t room_for_ellipsis = 0;  // longest prefix that leaves room for it
  while (!text.empty()) {
    const Character next = first_character(text);
    const bool shown = next.valid && !is_hidden(next.code);
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
    const Character next = first_character(text);
    if (!next.valid) return false;
    text.remove_prefix(next.bytes);
  }
  return true;
}

}  // namespace anticrack::words
