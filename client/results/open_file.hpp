// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {

/// A file of HDF5 to read. Throws Error with `cure` where there is none, Fault where it is damaged.
Handle open_file(const std::filesystem::path& path, const std::string& cure);

/// The largest number of bytes an honest dataset of the file takes in memory.
std::uint64_t memory_budget(const std::filesystem::path& path);

}  // namespace anticrack::results::hdf5
