// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/hdf5_chunks.hpp"

#include <zlib.h>

#include <algorithm>
#include <future>
#include <thread>
#include <vector>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {
namespace {

using Bytes = std::vector<unsigned char>;

/// The checksum of HDF5's filter: Fletcher's over words of two bytes, the first one the higher.
std::uint32_t fletcher32(std::span<const unsigned char> bytes) {
  constexpr std::size_t until_overflow = 2 * 360;
  std::uint32_t sum = 0, of_sums = 0;
  const auto fold = [](std::uint32_t& one) { one = (one & 0xffff) + (one >> 16); };
  while (!bytes.empty()) {
    const auto some = bytes.first(std::min(until_overflow, bytes.size()));
    for (std::size_t i = 0; i < some.size(); i += 2) {
      sum += static_cast<std::uint32_t>(some[i]) << 8;
      if (i + 1 < some.size()) sum += some[i + 1];
      of_sums += sum;
    }
    fold(sum);
    fold(of_sums);
    bytes = bytes.subspan(some.size());
  }
  fold(sum);
  fold(of_sums);
  return of_sums << 16 | sum;
}

/// A chunk of entries of `entry` bytes, filtered; what it lacks of `size` bytes is 0.
Bytes filtered(std::span<const std::byte> chunk, std::size_t size, std::size_t entry) {
  Bytes shuffled(size, 0);
  const std::size_t count = size / entry;
  for (std::size_t i = 0; i < chunk.size() / entry; ++i)
    for (std::size_t b = 0; b < entry; ++b)
      shuffled[b * count + i] = static_cast<unsigned char>(chunk[i * entry + b]);
  uLongf length = compressBound(size);
  Bytes result(length);
  if (compress2(result.data(), &length, shuffled.data(), size, deflate_level) != Z_OK)
    throw Fault("zlib cannot compress");
  result.resize(length);
  const std::uint32_t sum = fletcher32(result);
  for (unsigned shift = 0; shift < 32; shift += 8)
    result.push_back(static_cast<unsigned char>(sum >> shift));
  return result;
}

}  // namespace

void write_chunks(hid_t dataset, const Shape& shape, std::uint64_t rows,
                  std::span<const std::byte> values) {
  const std::size_t entry = values.size() / count_of(shape), row = values.size() / shape[0],
                    size = rows * row;
  const std::size_t at_once = std::max(1U, std::thread::hardware_concurrency());
  std::vector<hsize_t> place(shape.size(), 0);
  std::vector<std::future<Bytes>> made;
  while (place[0] < shape[0]) {
    made.clear();
    for (std::size_t k = 0; k < at_once && !values.empty(); ++k) {
      const auto chunk = values.first(std::min(size, values.size()));
      values = values.subspan(chunk.size());
      made.push_back(std::async([=] { return filtered(chunk, size, entry); }));
    }
    for (std::future<Bytes>& one : made) {
      const Bytes bytes = one.get();
      if (H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, place.data(), bytes.size(), bytes.data()) < 0)
        throw Fault("HDF5 does not take a chunk");
      place[0] += rows;
    }
  }
}

}  // namespace anticrack::results::hdf5
