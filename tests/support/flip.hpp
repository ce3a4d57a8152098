// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace anticrack::testing {

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Where a text begins in a file, each time.
inline std::vector<std::size_t> places_of(const std::string& text, const std::string& path) {
  const std::string content = content_of(path);
  std::vector<std::size_t> places;
  for (std::size_t at = content.find(text); at != std::string::npos;
       at = content.find(text, at + 1)) {
    places.push_back(at);
  }
  return places;
}

/// Flips a bit in each of `count` bytes of a file, as a bad disk does.
inline void flip(const std::string& path, std::size_t place, std::size_t count = 1) {
  std::string bytes = content_of(path).substr(place, count);
  for (char& byte : bytes) byte = static_cast<char>(byte ^ 1);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(place));
  file << bytes;
}

}  // namespace anticrack::testing
