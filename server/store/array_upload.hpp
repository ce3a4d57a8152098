// SPDX-License-Identifier: GPL-3.0-or-later
//
// Uploaded arrays: f64 little-endian, nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace anticrack::store {

/// Number of values in the file. Throws errors::Error: invalid_argument for a .msh (it begins with
/// $MeshFormat) and for a size that is zero or no multiple of 8; storage. Reads a few bytes.
std::size_t array_length(const std::string& path);

/// Throws as array_length does, and invalid_argument with the index of the first value that is not
/// finite. Reads the file in pieces.
void require_array(const std::string& path);

/// `count` values from index `first` on, whatever they are; nothing else is read. Throws storage
/// where the file is shorter.
std::vector<double> read_array_part(const std::string& path, std::uint64_t first,
                                    std::size_t count);

/// The values, all finite. Throws as require_array does.
std::vector<double> read_array(const std::string& path);

}  // namespace anticrack::store
