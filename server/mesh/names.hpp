// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace anticrack::mesh {

/// [A-Za-z][A-Za-z0-9_.-]{0,63}, whatever the locale: the names of inclusions and cracks.
constexpr bool valid_name(std::string_view name) noexcept {
  const auto letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
  if (name.empty() || name.size() > 64 || !letter(name.front())) return false;
  for (const char c : name)
    if (!letter(c) && !(c >= '0' && c <= '9') && c != '_' && c != '.' && c != '-') return false;
  return true;
}

inline constexpr std::string_view name_rule =
    "a letter, then at most 63 letters, digits, '_', '.' or '-'";

}  // namespace anticrack::mesh
