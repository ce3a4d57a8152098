// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <vector>

namespace anticrack::figures {
namespace {

std::string_view trimmed(std::string_view line) {
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  while (!line.empty() && (line.back() == ' ' || line.back() == '\n')) line.remove_suffix(1);
  return line;
}

/// "<g ...>" alone, or followed by its title.
bool only_opens_a_group(std::string_view line) {
  line = trimmed(line);
  if (!line.starts_with("<g ")) return false;
  const std::size_t end = line.find('>');
  if (end == std::string_view::npos) return false;
  const std::string_view rest = line.substr(end + 1);
  return rest.empty() || (rest.starts_with("<title>") && rest.ends_with("</title>"));
}

}  // namespace

std::string without_empty_groups(std::string_view svg) {
  std::vector<std::string_view> kept;
  while (!svg.empty()) {
    const std::string_view line =
        svg.substr(0, svg.find('\n') == std::string_view::npos ? svg.size() : svg.find('\n') + 1);
    svg.remove_prefix(line.size());
    if (trimmed(line) == "</g>" && !kept.empty() && only_opens_a_group(kept.back()))
      kept.pop_back();
    else
      kept.push_back(line);
  }
  std::string text;
  for (const std::string_view line : kept) text += line;
  return text;
}

}  // namespace anticrack::figures
