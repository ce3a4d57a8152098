// SPDX-License-Identifier: GPL-3.0-or-later
#include "words/nearest.hpp"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace anticrack::words {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> two_ago(width), one_ago(width), row(width);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(two_ago, one_ago);
    std::swap(one_ago, row);
    row[0] = i;
    for (std::size_t j = 1; j < width; ++j) {
      const std::size_t substitution = one_ago[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({one_ago[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_ago[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates) {
  // Bounds the cost of the distance; no key is this long.
  constexpr std::size_t longest_word = 100;
  if (word.size() > longest_word) return std::nullopt;
  const std::string sought = lower_case(word);
  std::optional<std::string> best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(sought, lower_case(candidate));
    const std::size_t longer = std::max(word.size(), candidate.size());
    const std::size_t allowed = std::max<std::size_t>(1, longer / 3);
    const bool near = distance <= allowed && distance < longer;
    if (near && (!best || distance < best_distance)) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  if (const auto meant = nearest(word, candidates)) return "did you mean " + *meant + "?";
  std::vector<std::string> known = candidates;
  std::sort(known.begin(), known.end());
  std::string list = "known are ";
  for (std::size_t i = 0; i < known.size(); ++i) list += (i == 0 ? "" : ", ") + known[i];
  return list;
}

}  // namespace anticrack::words
