// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/array_upload.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>

#include "errors/errors.hpp"

namespace anticrack::store {
namespace {

using errors::Error;
using errors::Reason;

static_assert(std::endian::native == std::endian::little, "arrays are little-endian");

Error unreadable(const std::string& path) {
  return {Reason::storage, "cannot read " + path + "; upload it again"};
}

bool begins_like_msh(const std::string& path) {
  constexpr std::string_view magic = "$MeshFormat";
  std::array<char, magic.size()> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return std::string_view(start.data(), static_cast<std::size_t>(file.gcount())) == magic;
}

/// visit(values) for one piece of the file after the other.
template <class Visit>
void read_pieces(const std::string& path, std::size_t count, Visit&& visit) {
  std::ifstream file(path, std::ios::binary);
  std::array<double, 8192> piece{};
  for (std::size_t first = 0; first < count; first += piece.size()) {
    const std::span<double> values(piece.data(), std::min(piece.size(), count - first));
    if (!file.read(reinterpret_cast<char*>(values.data()),
                   static_cast<std::streamsize>(values.size_bytes()))) {
      throw unreadable(path);
    }
    const auto bad = std::find_if(values.begin(), values.end(),
                                  [](double value) { return !std::isfinite(value); });
    if (bad != values.end()) {
      throw Error(Reason::invalid_argument,
                  "value " +
                      std::to_string(first + static_cast<std::size_t>(bad - values.begin())) +
                      " of the array is " + std::to_string(*bad) + "; all must be finite");
    }
    visit(values);
  }
}

}  // namespace

std::size_t array_length(const std::string& path) {
  std::error_code code;
  const auto bytes = std::filesystem::file_size(path, code);
  if (code) {
    throw unreadable(path);
  }
  if (begins_like_msh(path)) {
    throw Error(Reason::invalid_argument,
                "the upload is a .msh, not an array of values; upload the values as CONTENT_ARRAY");
  }
  if (bytes == 0 || bytes % sizeof(double) != 0) {
    throw Error(Reason::invalid_argument, "the upload has " + std::to_string(bytes) +
                                              " bytes; an array of f64 has 8 for each value");
  }
  return static_cast<std::size_t>(bytes / sizeof(double));
}

void require_array(const std::string& path) {
  read_pieces(path, array_length(path), [](std::span<const double>) {});
}

std::vector<double> read_array_part(const std::string& path, std::uint64_t first,
                                    std::size_t count) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(first * sizeof(double)));
  std::vector<double> values(count);
  if (!file.read(reinterpret_cast<char*>(values.data()),
                 static_cast<std::streamsize>(count * sizeof(double)))) {
    throw unreadable(path);
  }
  return values;
}

std::vector<double> read_array(const std::string& path) {
  const std::size_t count = array_length(path);
  std::vector<double> values;
  values.reserve(count);
  read_pieces(path, count, [&](std::span<const double> piece) {
    values.insert(values.end(), piece.begin(), piece.end());
  });
  return values;
}

}  // namespace anticrack::store
