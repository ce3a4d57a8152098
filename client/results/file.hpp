// SPDX-License-Identifier: GPL-3.0-or-later
//
// The result file, HDF5, format "anticrack-result/1": README.md has the table of what is in it,
// made of tables.hpp. Every dataset has the attribute `units`, some their `meaning`. Numbers are
// float64, int32 and uint8, little-endian; text is variable-length UTF-8. Needs HDF5 1.10 to read.
#pragma once

#include <filesystem>
#include <string_view>

#include "results/error.hpp"
#include "results/result.hpp"

namespace anticrack::results {

inline constexpr std::string_view format = "anticrack-result/1";

/// Writes the file whole or not at all: a temporary file in the same folder, fsync, rename. An
/// existing file is replaced; after an Error it is as it was and nothing else is left.
/// Needs memory for a copy of the file. Not from two threads at a time unless HDF5 is thread-safe.
void write(const std::filesystem::path& path, const Result& result);

/// Reads a file of `format`. Throws Error for what is not HDF5, truncated, foreign, of another
/// format version or inconsistent. Sizes are checked before memory is taken for them.
Result read(const std::filesystem::path& path);

/// Throws Error if `write` could not write here now: folder missing or read-only, path a folder, or
/// an existing file that is write-protected. Call it before hours of computation.
void check_writable(const std::filesystem::path& path);

}  // namespace anticrack::results
