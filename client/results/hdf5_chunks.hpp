// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes large datasets faster than HDF5, whose filters run on one thread.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "results/arrays.hpp"

namespace anticrack::results::hdf5 {

/// Higher levels take several times as long and save only a twentieth of the size.
constexpr unsigned deflate_level = 1;

/// Writes all entries of a dataset whose filters are shuffle, deflate at `deflate_level` and
/// fletcher32, in chunks of `rows` whole rows. `values`: the entries in order, as they are in the
/// file. The bytes are those that HDF5 would write. Takes memory for a chunk on each processor.
void write_chunks(hid_t dataset, const Shape& shape, std::uint64_t rows,
                  std::span<const std::byte> values);

}  // namespace anticrack::results::hdf5
