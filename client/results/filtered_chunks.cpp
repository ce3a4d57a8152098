// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/filtered_chunks.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>

namespace anticrack::results::hdf5 {
namespace {

/// First bytes of all values, then second bytes, and so on.
std::vector<std::byte> shuffled(std::span<const std::byte> values, std::size_t value_bytes,
                                std::size_t count) {
  std::vector<std::byte> planes(count * value_bytes);  // zeros beyond the values
  for (std::size_t i = 0; i < values.size(); ++i)
    planes[i % value_bytes * count + i / value_bytes] = values[i];
  return planes;
}

/// HDF5's variant: words of two bytes, the higher one first.
std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  std::uint32_t sum = 0;
  std::uint32_t sum_of_sums = 0;
  const auto add = [&](std::uint32_t word) {
    sum += word;
    sum_of_sums += sum;
  };
  const auto fold = [](std::uint32_t& value) { value = (value & 0xffffU) + (value >> 16U); };
  constexpr std::size_t most = 720;  // bytes before the second sum overflows
  while (bytes.size() > 1) {
    const std::size_t count = std::min(most, bytes.size() / 2 * 2);
    for (std::size_t i = 0; i < count; i += 2) {
      add(std::to_integer<std::uint32_t>(bytes[i]) << 8U |
          std::to_integer<std::uint32_t>(bytes[i + 1]));
    }
    fold(sum);
    fold(sum_of_sums);
    bytes = bytes.subspan(count);
  }
  if (!bytes.empty()) {
    add(std::to_integer<std::uint32_t>(bytes[0]) << 8U);
    fold(sum);
    fold(sum_of_sums);
  }
  fold(sum);
  fold(sum_of_sums);
  return sum_of_sums << 16U | sum;
}

/// Empty where it does not get smaller.
std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
  std::vector<std::byte> smaller(bytes.size());
  uLongf size = smaller.size();
  if (::compress2(reinterpret_cast<Bytef*>(smaller.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(),
                  deflate_level) != Z_OK)
    return {};
  smaller.resize(size);
  return smaller;
}

}  // namespace

std::size_t chunk_rows(std::size_t rows, std::size_t columns) {
  return std::min(rows,
                  std::max<std::size_t>(chunk_entries / std::max<std::size_t>(columns, 1), 1));
}

FilteredChunks filtered_chunks(std::span<const std::byte> values, std::size_t value_bytes,
                               std::size_t columns) {
  const std::size_t width = std::max<std::size_t>(columns, 1);
  const std::size_t rows = values.size() / value_bytes / width;
  if (rows * width < compressed_from) return {};
  const std::size_t entries = chunk_rows(rows, columns) * width;
  FilteredChunks chunks;
  while (!values.empty()) {
    const auto head = values.first(std::min(values.size(), entries * value_bytes));
    std::vector<std::byte> chunk = deflated(shuffled(head, value_bytes, entries));
    if (chunk.empty()) return {};
    const std::uint32_t sum = fletcher32(chunk);
    for (unsigned shift = 0; shift < 32; shift += 8)
      chunk.push_back(static_cast<std::byte>(sum >> shift));
    chunks.push_back(std::move(chunk));
    values = values.subspan(head.size());
  }
  return chunks;
}

}  // namespace anticrack::results::hdf5
