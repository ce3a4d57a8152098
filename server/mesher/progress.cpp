// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/progress.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace anticrack::mesher {
namespace {

constexpr std::size_t longest_words = 60;
constexpr std::size_t head = 2 + sizeof(std::uint64_t);  // mark, length of the words, triangles

}  // namespace

std::vector<std::byte> encode(const Progress& progress) {
  const std::string_view words = std::string_view(progress.doing).substr(0, longest_words);
  std::vector<std::byte> bytes(head + words.size());
  bytes[0] = report_mark;
  bytes[1] = static_cast<std::byte>(words.size());
  std::memcpy(&bytes[2], &progress.triangles, sizeof progress.triangles);
  std::memcpy(bytes.data() + head, words.data(), words.size());
  return bytes;
}

std::optional<std::pair<Progress, std::size_t>> first_report(std::span<const std::byte> bytes) {
  if (bytes.size() < head) return std::nullopt;
  const auto size = std::to_integer<std::size_t>(bytes[1]);
  if (bytes.size() < head + size) return std::nullopt;
  Progress progress;
  std::memcpy(&progress.triangles, &bytes[2], sizeof progress.triangles);
  for (const std::byte one : bytes.subspan(head, std::min(size, longest_words))) {
    const auto letter = std::to_integer<char>(one);
    const bool plain = (letter >= 'a' && letter <= 'z') || letter == ' ' || letter == '.';
    if (plain) progress.doing.push_back(letter);
  }
  return std::pair(std::move(progress), head + size);
}

}  // namespace anticrack::mesher
