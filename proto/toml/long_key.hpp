// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace anticrack::toml_text {

/// Keys of case files and configurations have at most 5 parts. Together with the 256 nested values
/// that toml++ allows, this bounds the depth of its tables, which it frees recursively.
constexpr std::size_t most_key_parts = 32;

/// For a key of more parts, where known keys have at most `known`.
inline std::string long_key_message(int known) {
  return "a key of more than " + std::to_string(most_key_parts) +
         " parts; shorten it: known keys have at most " + std::to_string(known);
}

namespace detail {

/// Past the string that begins at `at`, which ends at the latest with its line unless it has three
/// quotes.
inline std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const auto triple = [&](std::size_t i) {
    return i + 2 < text.size() && text[i] == quote && text[i + 1] == quote && text[i + 2] == quote;
  };
  const bool long_string = triple(at);
  for (at += long_string ? 3 : 1; at < text.size(); ++at) {
    if (!long_string && (text[at] == quote || text[at] == '\n')) {
      return text[at] == quote ? at + 1 : at;
    }
    if (long_string && triple(at)) {
      at += 3;
      for (int i = 0; i < 2 && at < text.size() && text[at] == quote; ++i) ++at;
      return at;
    }
    // An escaped line break ends a short string all the same.
    if (text[at] == '\\' && quote == '"' && at + 1 < text.size() && text[at + 1] != '\n') ++at;
  }
  return at;
}

}  // namespace detail

/// The line, from 1, of the first dotted key of more than most_key_parts parts. toml++ recurses for
/// each part, so such a text must not reach it. Dots in strings and comments do not count. O(n).
inline std::optional<unsigned> line_of_long_key(std::string_view text) {
  std::size_t dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = detail::end_of_string(text, at);
    } else if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else {
      if (std::string_view("\n=,[]{}").find(c) != std::string_view::npos) dots = 0;
      if (c == '.' && ++dots >= most_key_parts) {
        return 1 + static_cast<unsigned>(std::count(
                       text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
      }
      ++at;
    }
  }
  return std::nullopt;
}

}  // namespace anticrack::toml_text
