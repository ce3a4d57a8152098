// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/stems.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace anticrack::output {
namespace {

bool is_alphanumeric(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace

std::vector<std::string> file_stems(const std::vector<std::string>& names,
                                    const std::vector<std::string>& suffixes) {
  std::set<std::string> taken;
  const auto files_of = [&](const std::string& stem) {
    std::vector<std::string> files{lower(stem)};
    for (const std::string& suffix : suffixes) files.push_back(lower(stem + suffix));
    return files;
  };
  std::vector<std::string> stems;
  for (const std::string& name : names) {
    std::string base;
    for (const char c : name) base += is_alphanumeric(c) || c == '.' || c == '-' ? c : '_';
    if (base.empty() || !is_alphanumeric(base[0])) base.insert(0, "load");
    std::string stem = base;
    for (int copy = 2;; ++copy) {
      const auto files = files_of(stem);
      if (std::none_of(files.begin(), files.end(),
                       [&](const std::string& file) { return taken.count(file) != 0; })) {
        taken.insert(files.begin(), files.end());
        break;
      }
      stem = fmt::format("{}-{}", base, copy);
    }
    stems.push_back(stem);
  }
  return stems;
}

}  // namespace anticrack::output
