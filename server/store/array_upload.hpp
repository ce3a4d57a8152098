// SPDX-License-Identifier: GPL-3.0-or-later
//
// Uploaded arrays: f64 little-endian, nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace anticrack::store {

/// Whether these first bytes of a file are those of a .msh. No array begins so.
bool begins_like_msh(std::span<const std::byte> start);

/// Number of values in the file. Throws errors::Error: invalid_argument for a .msh (it begins with
/// $MeshFormat) and for a size that is zero or no multiple of 8; storage. Reads a few bytes.
std::size_t array_length(const std::string& path);

/// Looks at an array while it arrives.
class ArrayCheck {
 public:
  /// The next bytes. Throws errors::Error, invalid_argument: the array begins like a .msh, or has a
  /// value that is not finite (the first one is named by its index).
  void add(std::span<const std::byte> bytes);

 private:
  std::vector<std::byte> _part;  ///< of a value that is not all there yet
  std::uint64_t _values = 0;     ///< before it
};

/// `count` values from index `first` on, whatever they are; nothing else is read. Throws storage
/// where the file is shorter.
std::vector<double> read_array_part(const std::string& path, std::uint64_t first,
                                    std::size_t count);

/// The values. Throws as array_length does, and invalid_argument where one is not finite.
std::vector<double> read_array(const std::string& path);

}  // namespace anticrack::store
