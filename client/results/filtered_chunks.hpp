// SPDX-License-Identifier: GPL-3.0-or-later
//
// What HDF5's filters shuffle, deflate and fletcher32 make of an array, made without HDF5. For the
// sources of this folder only.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace anticrack::results::hdf5 {

/// Below this many entries compression saves nothing to speak of.
inline constexpr std::size_t compressed_from = 2048;
inline constexpr std::size_t chunk_entries = 65536;
inline constexpr int deflate_level = 6;

/// Rows of a chunk of an array of so many rows; `columns` 0: of one dimension.
std::size_t chunk_rows(std::size_t rows, std::size_t columns);

using FilteredChunks = std::vector<std::vector<std::byte>>;

/// The chunks of a dataset of values of `value_bytes` each, in order. Empty for fewer than
/// compressed_from entries, and where a chunk does not get smaller.
FilteredChunks filtered_chunks(std::span<const std::byte> values, std::size_t value_bytes,
                               std::size_t columns);

}  // namespace anticrack::results::hdf5
