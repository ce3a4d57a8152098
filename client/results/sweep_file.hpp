// SPDX-License-Identifier: GPL-3.0-or-later
//
// /sweep of the result file. For the sources of this folder only.
#pragma once

#include <cstdint>

#include "results/hdf5.hpp"
#include "results/sweep.hpp"

namespace anticrack::results {

/// Throws hdf5::Fault.
void put_sweep(const hdf5::Handle& root, const Sweep& sweep);

/// Lengths and ranges are not checked yet. Throws hdf5::Fault.
Sweep get_sweep(const hdf5::Handle& root, std::uint64_t budget);

}  // namespace anticrack::results
