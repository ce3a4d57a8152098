// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {

/// The bytes of an HDF5 file (format 1.10) that `fill` wrote into, made in memory. HDF5 then never
/// meets a full disk: in the middle of closing a file that makes it crash when the program ends.
std::vector<std::byte> file_image(const std::function<void(const Handle& file)>& fill);

}  // namespace anticrack::results::hdf5
