// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/array_upload.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include "errors/errors.hpp"
#include "store/files.hpp"

namespace anticrack::store {
namespace {

using errors::Error;
using errors::Reason;

static_assert(std::endian::native == std::endian::little, "arrays are little-endian");

Error unreadable(const std::string& path) {
  return {Reason::storage, "cannot read " + path + "; upload it again"};
}

Error no_array() {
  return {Reason::invalid_argument,
          "the upload is a .msh, not an array of values; upload the values as KIND_ARRAY"};
}

/// Has no branch for each value, so that the compiler handles several at once.
bool all_finite(std::span<const double> values) {
  constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000;
  bool finite = true;
  for (const double value : values)
    finite &= (std::bit_cast<std::uint64_t>(value) & exponent) != exponent;
  return finite;
}

/// Throws for the first value that is not finite. `first`: index of the first value.
void require_finite(std::span<const double> values, std::uint64_t first) {
  if (all_finite(values)) return;
  const auto bad = std::ranges::find_if_not(values, [](double v) { return std::isfinite(v); });
  throw Error(Reason::invalid_argument, "value {} of the array is {}; all must be finite",
              first + static_cast<std::size_t>(bad - values.begin()), *bad);
}

constexpr std::string_view msh_start = "$MeshFormat";

bool begins_like_msh(std::span<const std::byte> start) {
  return start.size() >= msh_start.size() &&
         std::memcmp(start.data(), msh_start.data(), msh_start.size()) == 0;
}

}  // namespace

bool is_msh(const base::Descriptor& file, const std::string& path) {
  std::array<std::byte, msh_start.size()> start{};
  const bool long_enough = file_size(file, path) >= start.size();
  if (long_enough) read_at(file, path, 0, start);
  return long_enough && begins_like_msh(start);
}

std::size_t array_length(const std::string& path) {
  const base::Descriptor file = open_to_read(path);
  if (!file) throw unreadable(path);
  const std::uint64_t bytes = file_size(file, path);
  if (is_msh(file, path)) throw no_array();
  if (bytes == 0 || bytes % sizeof(double) != 0) {
    throw Error(Reason::invalid_argument,
                "the upload has {} bytes; an array of f64 has 8 for each value", bytes);
  }
  return static_cast<std::size_t>(bytes / sizeof(double));
}

void ArrayCheck::add(std::span<const std::byte> bytes) {
  if (_values == 0 && _part.empty() && begins_like_msh(bytes)) throw no_array();
  std::array<double, 4096> values;
  while (!bytes.empty()) {
    // The number of whole values; the first one began in the bytes before.
    const std::size_t count = std::min(_part.size() + bytes.size(), sizeof values) / sizeof(double);
    const std::size_t taken = count == 0 ? bytes.size() : count * sizeof(double) - _part.size();
    if (count == 0) {
      _part.insert(_part.end(), bytes.begin(), bytes.end());
    } else {
      auto* to = reinterpret_cast<std::byte*>(values.data());
      to = std::ranges::copy(_part, to).out;
      std::ranges::copy(bytes.first(taken), to);
      _part.clear();
      require_finite(std::span(values).first(count), _values);
      _values += count;
    }
    bytes = bytes.subspan(taken);
  }
}

std::vector<double> read_array_part(const std::string& path, std::uint64_t first,
                                    std::size_t count) {
  const base::Descriptor file = open_to_read(path);
  if (!file) throw unreadable(path);
  std::vector<double> values(count);
  read_at(file, path, first * sizeof(double), std::as_writable_bytes(std::span(values)));
  return values;
}

std::vector<double> read_array(const std::string& path) {
  std::vector<double> values(array_length(path));
  const base::Descriptor file = open_to_read(path);
  if (!file) throw unreadable(path);
  read_at(file, path, 0, std::as_writable_bytes(std::span(values)));
  require_finite(values, 0);
  return values;
}

}  // namespace anticrack::store
