// SPDX-License-Identifier: GPL-3.0-or-later
//
// Uploaded arrays: f64 little-endian, nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/descriptor.hpp"

namespace anticrack::store {

/// Whether a file is a .msh, by its first bytes. No array begins like that. Throws as read_at does.
bool is_msh(const base::Descriptor& file, const std::string& path);

/// The number of values in a file. Throws errors::Error: invalid_argument for a .msh (it begins
/// with $MeshFormat) and for a size that is zero or no multiple of 8; storage. Reads a few bytes.
std::size_t array_length(const std::string& path);

/// Checks an array while it arrives.
class ArrayCheck {
 public:
  /// Takes the next bytes. Throws errors::Error (invalid_argument) if the array begins like a .msh,
  /// or has a value that is not finite (the message has the index of the first).
  void add(std::span<const std::byte> bytes);

 private:
  std::vector<std::byte> _part;  ///< the bytes so far of a value that is not complete
  std::uint64_t _values = 0;     ///< number of values before it
};

/// `count` values from index `first` on, unchecked; nothing else is read. Throws storage if the
/// file is shorter.
std::vector<double> read_array_part(const std::string& path, std::uint64_t first,
                                    std::size_t count);

/// All values of a file. Throws as array_length does, and invalid_argument if one is not finite.
std::vector<double> read_array(const std::string& path);

}  // namespace anticrack::store
